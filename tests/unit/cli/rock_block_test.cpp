#include "client_sample/cli/rock_block.hpp"

#include <gtest/gtest.h>

namespace talus::cli {
namespace {

constexpr int kSlice = 2;

/// Ground, and on it a wall 16 voxels high and 24 thick along x.
RockBlock wall() {
  RockBlock out{96, 24, 64, {}};
  out.rock.assign(out.at(0, out.height, 0), 0);
  for (int y = 0; y < out.height; ++y) {
    for (int z = 0; z < out.depth; ++z) {
      for (int x = 0; x < out.width; ++x) {
        out.rock[out.at(x, y, z)] = y == 0 || (y < 17 && z >= 20 && z < 44) ? 1 : 0;
      }
    }
  }
  return out;
}

void dig(RockBlock& block, int x0, int x1, int z0, int z1) {
  for (int y = 1; y < 9; ++y) {
    for (int z = z0; z < z1; ++z) {
      for (int x = x0; x < x1; ++x) block.rock[block.at(x, y, z)] = 0;
    }
  }
}

TEST(RockBlock, AWayThroughAWallIsAnArchAndADeadEndIsACave) {
  RockBlock block = wall();
  EXPECT_TRUE(find_cavities(block, kSlice).empty());
  dig(block, 20, 28, 20, 44);
  dig(block, 60, 68, 20, 40);
  const auto found = find_cavities(block, kSlice);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(found[0].is_arch());
  EXPECT_FALSE(found[0].is_cave());
  EXPECT_TRUE(found[1].is_cave());
  EXPECT_FALSE(found[1].is_arch());
  EXPECT_EQ(count_overhangs(block, 2), 8 * 24 + 8 * 20);
  EXPECT_TRUE(find_detached(block).empty());
}

TEST(RockBlock, AShoreIsACliffWhereRockRisesBehindIt) {
  RockBlock block = wall();
  const int shore = coast_cells(block, kSlice);
  EXPECT_EQ(cliff_cells(block, kSlice, 10, 6), shore);
  // The upper half of the wall stands back by 8 voxels on both sides: no cliff within 6 of the shore.
  for (int y = 8; y < 17; ++y) {
    for (int z = 0; z < block.depth; ++z) {
      if (z >= 28 && z < 36) continue;
      for (int x = 0; x < block.width; ++x) block.rock[block.at(x, y, z)] = 0;
    }
  }
  EXPECT_EQ(coast_cells(block, kSlice), shore);
  EXPECT_EQ(cliff_cells(block, kSlice, 10, 6), 0);
  EXPECT_EQ(cliff_cells(block, kSlice, 10, 8), shore);
}

TEST(RockBlock, RockThatHangsOnNothingIsDetached) {
  RockBlock block = wall();
  for (int n = 0; n < 5; ++n) block.rock[block.at(30 + n, 20, 30)] = 1;
  const auto found = find_detached(block);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0], 5);
}

}  // namespace
}  // namespace talus::cli
