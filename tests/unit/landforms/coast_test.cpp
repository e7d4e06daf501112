#include "core/landforms/coast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kCoastSeed = 90210;

/// A plane of raw heights that rises along x, as the stage meets it and as it leaves it.
struct Shore {
  ColumnGrid grid;
  std::vector<float> relief_x, relief_z, hilliness, height, slope_x, slope_z, cliff, beach, workspace;

  Shore(const CoastControls& controls, const ColumnGrid& at, float rise, float first_m) : grid(at) {
    const std::size_t count = sample_count(grid);
    for (auto* array : {&relief_x, &relief_z, &hilliness, &height, &slope_x, &slope_z, &cliff, &beach})
      array->resize(count);
    workspace.resize(kCoastArrays * count);
    std::ranges::fill(relief_x, rise);
    std::ranges::fill(slope_x, rise);
    std::ranges::fill(hilliness, 0.5f);
    for (int k = 0; k < grid.depth; ++k) {
      for (int i = 0; i < grid.width; ++i) {
        height[index(i, k)] =
            first_m + rise * static_cast<float>(i * static_cast<double>(grid.step_voxel) * grid.voxel_m);
      }
    }
    coast(controls, grid, {relief_x, relief_z, hilliness}, {height, slope_x, slope_z, cliff, beach}, workspace);
  }
  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(k) * row_stride(grid) + static_cast<std::size_t>(i);
  }
  double at(int i, int k) const { return static_cast<double>(height[index(i, k)]); }
};

CoastControls cliffs_everywhere() {
  CoastControls c;
  c.cliff_share = 1;
  c.seed = 5;
  return c;
}

TEST(Coast, HasTheSlopesThatItsHeightsHave) {
  // Steps of 1/16 m: a wall of 1 : 5 bends within metres, and creases of joints are met by few columns.
  double sum = 0;
  int creases = 0;
  constexpr int kWidth = 150;
  for (int tile = 0; tile < 24; ++tile) {
    const Shore s(cliffs_everywhere(), {tile * 70'000, -tile * 9'000, 1, kWidth, 12, 0.0625}, 0.16f,
                  -30.0f + static_cast<float>(tile) * 2.5f);
    for (int k = 1; k < 11; ++k) {
      for (int i = 1; i < kWidth - 1; ++i) {
        const double dx = (s.at(i + 1, k) - s.at(i - 1, k)) / 0.125 - static_cast<double>(s.slope_x[s.index(i, k)]);
        const double dz = (s.at(i, k + 1) - s.at(i, k - 1)) / 0.125 - static_cast<double>(s.slope_z[s.index(i, k)]);
        const double error = std::max(std::abs(dx), std::abs(dz));
        creases += error > 0.02 ? 1 : 0;
        sum += error > 0.02 ? 0 : error;
      }
    }
  }
  constexpr int kColumns = 24 * 10 * (kWidth - 2);
  EXPECT_LT(creases, kColumns / 50);
  EXPECT_LT(sum / kColumns, 2e-3);
}

TEST(Coast, KeepsTheOrderOfHeightsInAColumnAndItsBound) {
  CoastControls most = cliffs_everywhere();
  most.cliff_m = 90;
  most.cliff_vary_m = 37;
  most.fin_m = 15;
  most.joint_m = 1.5;
  test::Random random(kCoastSeed);
  for (int round = 0; round < 60; ++round) {
    const ColumnGrid grid{random.whole(-1'000'000, 1'000'000), random.whole(-1'000'000, 1'000'000), 1, 1, 1, 1};
    double last = -1e9;
    for (double raw = -140; raw < 480; raw += 1.7) {
      const Shore s(most, grid, 0.15f, static_cast<float>(raw));
      ASSERT_GT(s.at(0, 0), last) << "raw height " << raw << ", seed " << kCoastSeed << ", round " << round;
      last = s.at(0, 0);
      const glm::dvec2 bound = coast_bound(most, {raw, raw});
      ASSERT_GE(last, bound.x - 1e-4) << raw;
      ASSERT_LE(last, bound.y + 1e-4) << raw;
    }
  }
}

TEST(Coast, LeavesTheInlandAndTheDeepSeaUntouched) {
  for (const float raw : {-4000.0f, -90.5f, 441.0f, 2500.0f}) {
    const Shore s(cliffs_everywhere(), {0, 0, 1, 1, 1, 1}, 0.2f, raw);
    EXPECT_EQ(s.height[0], raw);
    EXPECT_EQ(s.slope_x[0], 0.2f);
    EXPECT_EQ(s.cliff[0], 0.0f);
  }
}

TEST(Coast, DependsOnThePointAndNotOnTheGrid) {
  // 1200 m of shore from the deep sea to the hills; single columns of it may skip the stage.
  const Shore whole(cliffs_everywhere(), {1'000, 2'000, 8, 150, 3, 1}, 0.5f, -100.0f);
  for (int i = 0; i < 150; ++i) {
    const Shore one(cliffs_everywhere(), {1'000 + 8 * i, 2'008, 1, 1, 1, 1}, 0.5f,
                    static_cast<float>(-100.0 + 0.5 * 8 * i));
    ASSERT_EQ(one.height[0], whole.height[whole.index(i, 1)]);
    ASSERT_EQ(one.cliff[0], whole.cliff[whole.index(i, 1)]);
  }
}

TEST(Coast, LeavesShoresOfPlainsWithoutCliffs) {
  Shore plain(cliffs_everywhere(), {0, 0, 1, 64, 8, 1}, 0.01f, -0.3f);
  EXPECT_LT(*std::ranges::max_element(plain.cliff), 12.0f) << "hilliness alone makes no whole cliff";
  CoastControls none = cliffs_everywhere();
  none.cliff_share = 0;
  double sum = 0;
  for (int tile = 0; tile < 40; ++tile) {
    const Shore s(none, {tile * 40'000, 0, 1, 1, 1, 1}, 0.15f, 3.0f);
    sum += static_cast<double>(s.cliff[0]);
  }
  EXPECT_LT(sum / 40, 5.0);
}

TEST(Coast, GivesGentleShoresABarAFaceABermAndADuneFoot) {
  CoastControls c;
  c.cliff_share = 0;
  // From 5 m under water to 7 m above in 300 m.
  const Shore s(c, {0, 0, 2, 150, 2, 1}, 0.04f, -5.0f);
  const auto rise = [&](double from_raw_m, double to_raw_m) {
    const auto column = [](double raw_m) { return static_cast<int>((raw_m + 5.0) / 0.08); };
    return (s.at(column(to_raw_m), 0) - s.at(column(from_raw_m), 0)) / (to_raw_m - from_raw_m);
  };
  EXPECT_LT(rise(-2.0, -1.2), 0.6) << "the bar's lee is flat";
  EXPECT_GT(rise(-0.4, 0.6), 1.5) << "the face is steep";
  EXPECT_LT(rise(1.4, 2.8), 0.6) << "the berm is flat";
  EXPECT_GT(rise(3.8, 5.2), 1.2) << "dunes rise behind it";
  EXPECT_GT(s.beach[s.index(70, 0)], 0.95f);
  for (int i = 1; i < 150; ++i) ASSERT_GT(s.at(i, 0), s.at(i - 1, 0));
}

TEST(Coast, GivesTheSameBitsOnEveryTarget) {
  const ColumnGrid grid{-5'000'000'123, 77, 3, 35, 9, 1};
  const Shore best(cliffs_everywhere(), grid, 0.2f, -9.0f);
  const int targets = test::for_each_simd_target([&](const char* target) {
    const Shore s(cliffs_everywhere(), grid, 0.2f, -9.0f);
    for (int k = 0; k < grid.depth; ++k) {
      const auto row = s.index(0, k);
      EXPECT_EQ(std::memcmp(&s.height[row], &best.height[row], 35 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&s.slope_x[row], &best.slope_x[row], 35 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&s.cliff[row], &best.cliff[row], 35 * sizeof(float)), 0) << target;
    }
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
