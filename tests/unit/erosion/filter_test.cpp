#include "core/erosion/filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/unit/erosion/filter_reference.hpp"

namespace talus {
namespace {

/// A smooth hill with its slopes, and what the filter makes of it.
struct Case {
  ColumnGrid grid;
  std::vector<float> slope_x, slope_z, fade, strength, frequency;
  std::vector<float> height, out_x, out_z, ridge, cut, cut_x, cut_z;

  explicit Case(const ColumnGrid& at) : grid(at) {
    for (auto* a : {&slope_x, &slope_z, &fade, &strength, &height, &out_x, &out_z, &ridge, &cut, &cut_x, &cut_z})
      a->resize(sample_count(at));
    for (int k = 0; k < at.depth; ++k) {
      for (int i = 0; i < at.width; ++i) {
        const double x = static_cast<double>(at.x_voxel + i * at.step_voxel) * at.voxel_m;
        const double z = static_cast<double>(at.z_voxel + k * at.step_voxel) * at.voxel_m;
        const std::size_t p = index(i, k);
        slope_x[p] = static_cast<float>(0.5 * std::cos(x / 700.0) + 0.1 * std::sin(z / 311.0));
        slope_z[p] = static_cast<float>(0.5 * std::sin(z / 900.0) - 0.2 * std::cos(x / 450.0));
        fade[p] = static_cast<float>(1.3 * std::sin(x / 700.0));
        strength[p] = static_cast<float>(0.6 + 0.4 * std::cos(z / 1200.0));
      }
    }
  }
  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(k) * row_stride(grid) + static_cast<std::size_t>(i);
  }
  void run(const ErosionControls& controls) {
    erode(controls, grid, {slope_x, slope_z, fade, strength, frequency},
          {height, out_x, out_z, ridge, cut, cut_x, cut_z});
  }
  void set_frequency(float share) { frequency.assign(sample_count(grid), share); }
};

struct Errors {
  double height_max = 0, height_mean = 0, ridge_mean = 0;
  int points = 0, outliers = 0;
};

Errors errors_against_reference(const ErosionControls& controls, Case& c) {
  c.run(controls);
  const auto reference = c.frequency.empty() ? test::erode_reference : test::erode_by_frequency_reference;
  Errors e;
  for (int k = 0; k < c.grid.depth; ++k) {
    for (int i = 0; i < c.grid.width; ++i) {
      const std::size_t p = c.index(i, k);
      const auto r = reference(controls, static_cast<double>(c.grid.x_voxel + i * c.grid.step_voxel) * c.grid.voxel_m,
                               static_cast<double>(c.grid.z_voxel + k * c.grid.step_voxel) * c.grid.voxel_m,
                               static_cast<double>(c.slope_x[p]), static_cast<double>(c.slope_z[p]),
                               static_cast<double>(c.fade[p]), static_cast<double>(c.strength[p]));
      const double error = std::abs(r.height_m - static_cast<double>(c.height[p]));
      // Where a sine changes its sign within rounding, straight gullies turn the other way and finer octaves differ: a
      // different, equally right branch of a rare point, faded out in the height. Counted apart.
      if (error > 0.05) ++e.outliers;
      e.height_max = std::max(e.height_max, error);
      e.height_mean += error;
      e.ridge_mean += std::abs(r.ridge - static_cast<double>(c.ridge[p]));
      ++e.points;
    }
  }
  e.height_mean /= e.points;
  e.ridge_mean /= e.points;
  return e;
}

TEST(ErosionFilter, AgreesWithTheFormulasInDoublePrecision) {
  Case c({-3'000, 5'000, 37, 128, 128, 1});
  const Errors e = errors_against_reference(ErosionControls{}, c);
  RecordProperty("height_max_mm", static_cast<int>(e.height_max * 1000));
  RecordProperty("height_mean_um", static_cast<int>(e.height_mean * 1e6));
  std::printf(
      "filter against double reference: height error max %.4f m, mean %.6f m, ridge mean %.6f, %d of %d over 5 cm\n",
      e.height_max, e.height_mean, e.ridge_mean, e.outliers, e.points);
  EXPECT_LT(e.height_mean, 2e-3) << "metres, of gullies 380 m deep";
  EXPECT_LT(e.outliers, e.points / 500);
  EXPECT_LT(e.ridge_mean, 1e-3);
}

TEST(ErosionFilter, AgreesWithTheFormulasForRandomControls) {
  const std::uint64_t seed = 20'261;
  test::Random random(seed);
  for (int round = 0; round < 12; ++round) {
    ErosionControls controls;
    controls.scale_m = random.real(200, 2000);
    controls.octaves = static_cast<int>(random.whole(0, 8));
    controls.strength = random.real(0.02, 0.4);
    controls.gain = random.real(0.3, 0.6);
    controls.lacunarity = random.real(1.7, 2.4);
    controls.gully_weight = random.real(0.1, 1);
    controls.detail = random.real(0.5, 3);
    controls.rounding_ridge = random.real(0, 0.3);
    controls.rounding_crease = random.real(0, 0.3);
    controls.rounding_input = random.real(0, 1);
    controls.rounding_octave = random.real(1, 2.5);
    controls.onset_input = random.real(0.5, 3);
    controls.onset_octave = random.real(0.5, 3);
    controls.ridge_onset_input = random.real(0.5, 4);
    controls.ridge_onset_octave = random.real(0.5, 4);
    controls.assumed_slope = random.real(0.2, 2);
    controls.assumed_blend = random.unit();
    controls.cell_scale = random.real(0.4, 1.2);
    controls.normalisation = random.real(0, 0.7);
    controls.offset = random.real(-0.5, 0.5);
    controls.frequency_slope = random.real(0.5, 5);
    controls.frequency_max = random.real(0.5, 3);
    controls.frequency_branch = random.real(0, 2);
    controls.frequency_pull = random.unit();
    controls.frequency_valley = random.unit();
    controls.seed = random.bits();
    Case c({random.whole(-1'000'000, 1'000'000), random.whole(-1'000'000, 1'000'000), 61, 48, 48, 1});
    const Errors e = errors_against_reference(controls, c);
    EXPECT_LT(e.height_mean, 4e-6 * controls.scale_m + 2e-3) << "seed " << seed << ", round " << round;
    EXPECT_LE(e.outliers, e.points / 50) << "seed " << seed << ", round " << round;
    c.set_frequency(1);
    const Errors f = errors_against_reference(controls, c);
    EXPECT_LT(f.height_mean, 4e-6 * controls.scale_m + 2e-3) << "frequency, seed " << seed << ", round " << round;
    EXPECT_LE(f.outliers, f.points / 50) << "frequency, seed " << seed << ", round " << round;
  }
}

TEST(FrequencyMethod, AgreesWithTheFormulasInDoublePrecision) {
  Case c({-3'000, 5'000, 37, 128, 128, 1});
  c.set_frequency(1);
  const Errors e = errors_against_reference(ErosionControls{}, c);
  std::printf("frequency method: height error max %.4f m, mean %.6f m, ridge mean %.6f, %d of %d over 5 cm\n",
              e.height_max, e.height_mean, e.ridge_mean, e.outliers, e.points);
  EXPECT_LT(e.height_mean, 2e-3);
  EXPECT_LT(e.outliers, e.points / 500);
  EXPECT_LT(e.ridge_mean, 1e-3);
}

TEST(FrequencyMethod, LeavesFlatsWhereTheyAreAndNeedsNoFadeTargetAsTheOriginal) {
  ErosionControls original;
  original.frequency_pull = 0;
  original.frequency_valley = 0;
  Case c({0, 0, 11, 96, 96, 1});
  c.set_frequency(1);
  c.run(original);
  const std::vector<float> with = c.height;
  std::ranges::fill(c.fade, -0.7f);
  c.run(original);
  EXPECT_EQ(c.height, with) << "a fade target mattered";
  EXPECT_LT(std::ranges::min(c.height), -100.0f) << "no gullies at all";
  EXPECT_LE(std::ranges::max(c.height), 0.01f) << "gullies are cut, nothing is heaped";
  std::ranges::fill(c.slope_x, 0.0f);
  std::ranges::fill(c.slope_z, 0.0f);
  c.run(original);
  for (const float height : c.height) ASSERT_NEAR(height, 0.0f, 1e-3f);
}

TEST(FrequencyMethod, BlendsByItsShareAndSkipsWithoutChangingABit) {
  const ColumnGrid grid{12'000, -7'000, 9, 96, 64, 1};
  Case fade(grid);
  fade.run(ErosionControls{});
  Case frequency(grid);
  frequency.set_frequency(1);
  frequency.run(ErosionControls{});
  // Shares in stripes of every width: whole vectors of 0 and 1, and vectors that hold both.
  Case both(grid);
  both.set_frequency(0);
  Case dry(grid);
  for (int k = 0; k < 64; ++k) {
    for (int i = 0; i < 96; ++i) {
      const float wave = 0.5f + std::sin(static_cast<float>(i) / (1.0f + static_cast<float>(k % 8)));
      both.frequency[both.index(i, k)] = std::clamp(wave, 0.0f, 1.0f);
      if (wave > 0.9f) dry.strength[dry.index(i, k)] = 0;
    }
  }
  both.run(ErosionControls{});
  dry.run(ErosionControls{});
  int pure = 0;
  for (int k = 0; k < 64; ++k) {
    for (int i = 0; i < 96; ++i) {
      const std::size_t p = fade.index(i, k);
      const float share = both.frequency[p];
      const float expected = share <= 0   ? fade.height[p]
                             : share >= 1 ? frequency.height[p]
                                          : fade.height[p] + (frequency.height[p] - fade.height[p]) * share;
      ASSERT_EQ(both.height[p], expected) << i << ' ' << k << ' ' << share;
      pure += share <= 0 || share >= 1 ? 1 : 0;
      ASSERT_EQ(dry.height[p], dry.strength[p] > 0 ? fade.height[p] : 0.0f);
      ASSERT_EQ(dry.ridge[p], dry.strength[p] > 0 ? fade.ridge[p] : 0.0f);
    }
  }
  EXPECT_GT(pure, 2'000);
}

TEST(FrequencyMethod, KeepsValleysSmoother) {
  // Roughness of the floor of a valley: bends of the eroded surface where the fade target is low.
  const auto floor_roughness = [](float share) {
    Case c({0, 9'000, 29, 160, 160, 1});
    c.set_frequency(share);
    c.run(ErosionControls{});
    double sum = 0;
    int count = 0;
    for (int k = 1; k < 159; ++k) {
      for (int i = 1; i < 159; ++i) {
        if (c.fade[c.index(i, k)] > -0.85f) continue;
        const auto h = [&](int a, int b) { return static_cast<double>(c.height[c.index(a, b)]); };
        sum += std::abs(h(i - 1, k) + h(i + 1, k) + h(i, k - 1) + h(i, k + 1) - 4 * h(i, k));
        ++count;
      }
    }
    EXPECT_GT(count, 500);
    return sum / count;
  };
  EXPECT_LT(floor_roughness(1), 0.2 * floor_roughness(0));
}

TEST(ErosionFilter, StaysWithinItsBoundAndItsRidgeMapWithinOne) {
  const ErosionControls controls;
  Case c({1'000'000'000, -1'000'000'000, 11, 160, 160, 1});
  for (const float share : {0.0f, 0.5f, 1.0f}) {
    c.set_frequency(share);
    c.run(controls);
    for (int k = 0; k < 160; ++k) {
      for (int i = 0; i < 160; ++i) {
        ASSERT_LE(std::abs(static_cast<double>(c.height[c.index(i, k)])), erosion_bound(controls) * 1.0001);
        ASSERT_LE(std::abs(c.ridge[c.index(i, k)]), 1.00001f);
      }
    }
  }
}

TEST(ErosionFilter, TellsHowFarFineGulliesCut) {
  ErosionControls controls;
  // Nothing but gullies, all of them fine: what is cut is all there is.
  controls.scale_m = kFineFull_m;
  controls.frequency_pull = 0;
  Case c({0, 0, 3, 120, 120, 1});
  c.set_frequency(1);
  c.run(controls);
  float deepest = 0;
  for (int k = 0; k < 120; ++k) {
    for (int i = 0; i < 120; ++i) {
      const std::size_t p = c.index(i, k);
      ASSERT_NEAR(c.cut[p], -c.height[p], 1e-3);
      ASSERT_NEAR(c.cut_x[p], -c.out_x[p], 1e-4);
      ASSERT_NEAR(c.cut_z[p], -c.out_z[p], 1e-4);
      deepest = std::max(deepest, c.cut[p]);
    }
  }
  EXPECT_GT(deepest, 5.0f);

  // The fade method cuts below crests alone, so never above, and wide gullies are not fine.
  controls = ErosionControls{};
  c.set_frequency(0);
  c.run(controls);
  EXPECT_GE(std::ranges::min(c.cut), 0.0f);
  EXPECT_GT(std::ranges::max(c.cut), 5.0f);
  EXPECT_LE(static_cast<double>(std::ranges::max(c.cut)), erosion_bound(controls));
  controls.octaves = 2;
  c.run(controls);
  EXPECT_EQ(std::ranges::max(c.cut), 0.0f) << "gullies of 500 m are not fine";
}

TEST(ErosionFilter, LeavesNothingBehindWithoutStrength) {
  Case c({0, 0, 5, 32, 32, 1});
  std::ranges::fill(c.strength, 0.0f);
  c.run(ErosionControls{});
  for (int k = 0; k < 32; ++k) {
    for (int i = 0; i < 32; ++i) ASSERT_EQ(c.height[c.index(i, k)] + c.cut[c.index(i, k)], 0.0f);
  }
}

TEST(ErosionFilter, GivesTheSameBitsOnEveryTarget) {
  Case best({1'000'000'000, -999'999'999, 7, 35, 35, 1});
  best.set_frequency(0.4f);
  best.run(ErosionControls{});
  const int targets = test::for_each_simd_target([&](const char* target) {
    Case c(best.grid);
    c.set_frequency(0.4f);
    c.run(ErosionControls{});
    for (int k = 0; k < 35; ++k) {
      const std::size_t row = c.index(0, k);
      EXPECT_EQ(std::memcmp(&c.height[row], &best.height[row], 35 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&c.ridge[row], &best.ridge[row], 35 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&c.out_x[row], &best.out_x[row], 35 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&c.cut[row], &best.cut[row], 35 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&c.cut_x[row], &best.cut_x[row], 35 * sizeof(float)), 0) << target;
    }
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
