#include "client_sample/cli/world_block.hpp"

#include <gtest/gtest.h>

namespace talus::cli {
namespace {

/// The largest piece of rock that hangs on nothing in a block of 64 m around a place, in cubic metres.
int loose_m3(glm::i64vec3 middle_voxel) {
  constexpr int kEdge = 64;
  const WorldFunction world{Manifest()};
  DensityBrick brick;
  WorldBlock block{middle_voxel - glm::i64vec3(kEdge / 2), kEdge, kEdge, kEdge, {}, {}, {}, {}};
  sample_block(world, brick, block);
  const auto pieces = find_detached(rock_of(block));
  return pieces.empty() ? 0 : pieces.front();
}

TEST(WorldBlock, HasNoTopOfAStackInTheAirWhereAnAlcoveCouldGoThrough) {
  EXPECT_LE(loose_m3({-37'010, 27, 2641}), 10);
}

TEST(WorldBlock, HasNoTipsOfBedsInTheAirInFrontOfAnAlcove) {
  EXPECT_LE(loose_m3({-14'750, 6, 51'465}), 10);
}

}  // namespace
}  // namespace talus::cli
