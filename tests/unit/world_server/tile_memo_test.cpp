#include "server/world/tile_memo.hpp"

#include <gtest/gtest.h>

#include "core/world/volume_scratch.hpp"
#include "core/world/world_function.hpp"

namespace talus::server {
namespace {

ReliefTile tile_named(std::uint64_t source, std::int64_t x, std::int64_t z) {
  ReliefTile tile;
  tile.name = {source, x, z};
  tile.height_m.fill(static_cast<float>(x));
  return tile;
}

TEST(TileMemo, KnowsWhatItWasToldAndNothingElse) {
  Metrics metrics;
  TileMemo memo(metrics);
  memo.store(4, tile_named(7, -3, 9));
  ReliefTile tile = tile_named(7, -3, 9);
  tile.height_m.fill(0);
  ASSERT_TRUE(memo.load(4, tile));
  EXPECT_EQ(tile.height_m[5], -3.0f);
  EXPECT_FALSE(memo.load(16, tile)) << "of the wide lattice";
  for (ReliefTile other : {tile_named(8, -3, 9), tile_named(7, 9, -3), tile_named(7, -3, 8)})
    EXPECT_FALSE(memo.load(4, other));
}

TEST(TileMemo, MayForgetButNeverLies) {
  Metrics metrics;
  TileMemo memo(metrics);
  for (std::int64_t n = 0; n < 10'000; ++n) memo.store(4, tile_named(1, n, -n));
  int known = 0;
  for (std::int64_t n = 0; n < 10'000; ++n) {
    ReliefTile tile = tile_named(1, n, -n);
    tile.height_m.fill(-1);
    if (!memo.load(4, tile)) continue;
    ++known;
    ASSERT_EQ(tile.height_m[0], static_cast<float>(n));
  }
  EXPECT_GT(known, 1'000);
  EXPECT_LE(known, 2'048);
}

TEST(TileMemo, SparesTheSecondThreadTheGroundThatTheFirstEvaluated) {
  const WorldFunction world{Manifest()};
  Metrics metrics;
  TileMemo memo(metrics);
  // A cliff coast of the default world.
  const ColumnGrid grid{4830, 39'260, 1, 35, 35, 1.0};
  const auto spheres = [&](TileSource* others) {
    VolumeScratch scratch;
    scratch.relief.others = others;
    ColumnBlock block;
    world.columns(grid, block);
    world.volume(block, scratch);
    EXPECT_TRUE(block.has_jut);
    return std::pair(block.jut_m, block.spheres.size());
  };
  const auto alone = spheres(nullptr);
  EXPECT_EQ(metrics.value(Count::kTilesEvaluated), 0U);
  EXPECT_EQ(spheres(&memo), alone);
  const std::uint64_t evaluated = metrics.value(Count::kTilesEvaluated);
  EXPECT_GT(evaluated, 2U);
  EXPECT_EQ(metrics.value(Count::kTilesRemembered), 0U);
  EXPECT_EQ(spheres(&memo), alone);
  // Two tiles may have one slot.
  EXPECT_GE(4 * metrics.value(Count::kTilesRemembered), 3 * evaluated);
  EXPECT_EQ(metrics.value(Count::kTilesRemembered) + metrics.value(Count::kTilesEvaluated), 2 * evaluated);
}

}  // namespace
}  // namespace talus::server
