#include "core/strata/terraces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

constexpr std::size_t kTerraceWidth = 160;

std::vector<LayerSet> some_sets() {
  std::vector<LayerSet> sets;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) sets.emplace_back(seed);
  return sets;
}

/// One row of columns whose heights rise along it.
struct TerraceRow {
  std::vector<float> stack, choice, weight, weight_x, weight_z, height, slope_x, slope_z;
  TerraceRow(float set_choice, float low_m, float step_m, float w) {
    stack.assign(kTerraceWidth, 3600.0f);
    choice.assign(kTerraceWidth, set_choice);
    weight.assign(kTerraceWidth, w);
    slope_x.assign(kTerraceWidth, 1.0f);
    for (auto* a : {&weight_x, &weight_z, &slope_z, &height}) a->assign(kTerraceWidth, 0.0f);
    for (std::size_t i = 0; i < kTerraceWidth; ++i) height[i] = low_m + step_m * static_cast<float>(i);
  }
  void cut(const Terraces& terraces) {
    terraces.row({stack.data(), choice.data(), weight.data(), weight_x.data(), weight_z.data(), height.data(),
                  slope_x.data(), slope_z.data(), kTerraceWidth});
  }
};

TEST(Terraces, KeepHeightsInOrderNearTheirsAndWithTheirSlopes) {
  const Terraces terraces(some_sets());
  for (const float choice : {0.0f, 1.5f, 2.9f, 3.0f}) {
    for (float low = -300; low < 900; low += 60) {
      TerraceRow row(choice, low, 0.4f, 1.0f);
      const std::vector<float> before = row.height;
      row.cut(terraces);
      for (std::size_t i = 0; i < kTerraceWidth; ++i) {
        ASSERT_LE(std::abs(row.height[i] - before[i]), terraces.reach_m());
        if (i == 0 || i + 1 == kTerraceWidth) continue;
        ASSERT_GT(row.height[i], row.height[i - 1]);
        ASSERT_NEAR((row.height[i + 1] - row.height[i - 1]) / 0.8f, row.slope_x[i], 0.2f);
      }
    }
  }
}

TEST(Terraces, AreWallsInHardRockAndTreadsInSoft) {
  const std::vector<LayerSet> sets = some_sets();
  const Terraces terraces(sets);
  double wall = 0;
  double tread = 1e9;
  for (float low = -300; low < 900; low += 60) {
    TerraceRow row(2.0f, low, 0.4f, 1.0f);
    row.cut(terraces);
    wall = std::max(wall, static_cast<double>(std::ranges::max(row.slope_x)));
    tread = std::min(tread, static_cast<double>(std::ranges::min(row.slope_x)));
  }
  EXPECT_GT(wall, 1.8) << "times the slope of the ground";
  EXPECT_LT(tread, 0.35);
}

TEST(Terraces, LeaveEveryBitWithoutWeightAndAreTheSameOnEveryTarget) {
  const Terraces terraces(some_sets());
  TerraceRow still(1.5f, 33, 1.7f, 0.0f);
  const std::vector<float> before = still.height;
  still.cut(terraces);
  EXPECT_EQ(still.height, before);
  TerraceRow best(1.5f, 33, 1.7f, 0.7f);
  best.cut(terraces);
  EXPECT_NE(best.height, before);
  const int targets = test::for_each_simd_target([&](const char* target) {
    TerraceRow row(1.5f, 33, 1.7f, 0.7f);
    row.cut(terraces);
    EXPECT_EQ(row.height, best.height) << target;
    EXPECT_EQ(row.slope_x, best.slope_x) << target;
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
