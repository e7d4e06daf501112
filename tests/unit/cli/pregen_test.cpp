#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "client_sample/cli/pregen_plan.hpp"

namespace talus::cli {
namespace {

std::vector<PregenPlan::Column> all_of(PregenPlan plan) {
  std::vector<PregenPlan::Column> out;
  while (const auto column = plan.next()) out.push_back(*column);
  return out;
}

TEST(PregenPlan, HasEveryColumnOfItsSquareOnceAndCoarseOnesFirst) {
  const protocol::WorldShape shape;
  const PregenPlan plan(shape, {-100, 700}, 1000, 0, 3);
  const auto columns = all_of(plan);
  EXPECT_EQ(columns.size(), plan.columns());
  std::set<std::tuple<int, int, int>> seen;
  int lod = 3;
  for (const auto& column : columns) {
    EXPECT_TRUE(seen.emplace(column.lod, column.x, column.z).second);
    EXPECT_LE(column.lod, lod);
    lod = column.lod;
  }
  // x from -600 to 400, z from 200 to 1200, in chunks of 32 m.
  for (int x = -19; x <= 12; ++x) {
    for (int z = 6; z <= 37; ++z) EXPECT_TRUE(seen.contains({0, x, z})) << x << ' ' << z;
  }
  EXPECT_EQ(std::count_if(columns.begin(), columns.end(), [](const auto& c) { return c.lod == 0; }), 32 * 32);
}

TEST(PregenPlan, EndsAtTheEdgeOfItsSquareAndOfTheWorld) {
  const protocol::WorldShape shape;
  EXPECT_EQ(PregenPlan(shape, {16, 16}, 32, 0, 0).columns(), 1U) << "the far border belongs to the next column";
  const auto last = all_of(PregenPlan(shape, {1e12, 1e12}, 1000, 0, 0));
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(last[0].x, kChunkLimit);
}

TEST(PregenPlan, KeepsColumnsThatShareGroundTogether) {
  const auto columns = all_of(PregenPlan({}, {0, 0}, 4096, 0, 0));
  ASSERT_GE(columns.size(), 64U);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_LT(columns[i].x - columns[0].x, 8);
    EXPECT_LT(columns[i].z - columns[0].z, 8);
  }
}

TEST(PregenPlan, AColumnReachesFromTheLowestToTheHighestPlaceOfTheWorld) {
  protocol::WorldShape shape;
  shape.height_range_m = {-10, 70};
  const auto chunks = PregenPlan(shape, {0, 0}, 32, 0, 0).chunks_of({0, 5, -7});
  ASSERT_EQ(chunks.size(), 4U);
  EXPECT_EQ(chunks.front(), (ChunkKey{0, 5, -1, -7}));
  EXPECT_EQ(chunks.back(), (ChunkKey{0, 5, 2, -7}));
}

}  // namespace
}  // namespace talus::cli
