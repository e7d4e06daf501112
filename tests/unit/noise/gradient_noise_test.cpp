#include "core/noise/gradient_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

struct Field {
  ColumnGrid grid;
  std::vector<float> value, slope_x, slope_z;
  Field(const FractalNoise& noise, const ColumnGrid& at)
      : grid(at), value(sample_count(at)), slope_x(sample_count(at)), slope_z(sample_count(at)) {
    fractal_noise(noise, at, value, slope_x, slope_z);
  }
  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(k) * row_stride(grid) + static_cast<std::size_t>(i);
  }
  double at(int i, int k) const { return static_cast<double>(value[index(i, k)]); }
};

constexpr FractalNoise kNoise{900, 4, 2.03, 0.4, 77};

TEST(GradientNoise, HasTheSlopesThatItsValuesHave) {
  // Steps of 1/4 m: the largest error of a central difference is third order in the finest wavelength, 100 m.
  const Field f(kNoise, {12'345, -6'789, 1, 120, 120, 0.25});
  double worst = 0;
  for (int k = 1; k < 119; ++k) {
    for (int i = 1; i < 119; ++i) {
      const double dx = (f.at(i + 1, k) - f.at(i - 1, k)) / 0.5;
      const double dz = (f.at(i, k + 1) - f.at(i, k - 1)) / 0.5;
      worst = std::max(worst, std::abs(dx - static_cast<double>(f.slope_x[f.index(i, k)])));
      worst = std::max(worst, std::abs(dz - static_cast<double>(f.slope_z[f.index(i, k)])));
    }
  }
  EXPECT_LT(worst, 2e-5) << "per metre, against slopes of about 5e-3";
}

TEST(GradientNoise, StaysWithinItsBoundAndUsesMostOfIt) {
  const FractalNoise one{500, 1, 2, 0.5, 3};
  double high = 0;
  double sum2 = 0;
  int count = 0;
  for (int tile = 0; tile < 20; ++tile) {
    const Field f(one, {tile * 100'000, tile * 31'000, 97, 128, 128, 1});
    for (int k = 0; k < 128; ++k) {
      for (int i = 0; i < 128; ++i, ++count) {
        high = std::max(high, std::abs(f.at(i, k)));
        sum2 += f.at(i, k) * f.at(i, k);
      }
    }
  }
  EXPECT_LE(high, noise_bound(one));
  EXPECT_GT(high, 0.6 * noise_bound(one));
  EXPECT_NEAR(std::sqrt(sum2 / count), 0.28, 0.02);
}

TEST(GradientNoise, DependsOnThePointAndNotOnTheGrid) {
  const Field whole(kNoise, {-40, 100, 2, 64, 64, 1});
  const Field part(kNoise, {-40 + 2 * 13, 100 + 2 * 29, 2, 7, 5, 1});
  const Field coarse(kNoise, {-40, 100, 4, 32, 32, 1});
  for (int k = 0; k < 5; ++k) {
    for (int i = 0; i < 7; ++i) EXPECT_EQ(part.at(i, k), whole.at(i + 13, k + 29));
  }
  for (int k = 0; k < 32; ++k) {
    for (int i = 0; i < 32; ++i) ASSERT_EQ(coarse.at(i, k), whole.at(2 * i, 2 * k));
  }
}

TEST(GradientNoise, IsAsRoughAMillionKilometresAwayAsAtTheOrigin) {
  const auto roughness = [](std::int64_t origin) {
    const Field f({20, 2, 2, 0.5, 5}, {origin, origin / 3, 1, 160, 160, 0.25});
    double sum2 = 0;
    for (int k = 1; k < 159; ++k) {
      for (int i = 1; i < 159; ++i) {
        const double bend = f.at(i + 1, k) - 2 * f.at(i, k) + f.at(i - 1, k);
        sum2 += bend * bend;
      }
    }
    return std::sqrt(sum2);
  };
  double near = 0;
  double far = 0;
  for (int tile = 0; tile < 16; ++tile) {
    near += roughness(tile * 10'000);
    far += roughness(4'000'000'000 + tile * 10'000);
  }
  EXPECT_NEAR(far / near, 1.0, 0.15);
}

TEST(GradientNoise, GivesTheSameBitsOnEveryTarget) {
  const ColumnGrid grid{-5'000'000'123, 77, 3, 35, 35, 1};
  const Field best(kNoise, grid);
  const int targets = test::for_each_simd_target([&](const char* target) {
    const Field f(kNoise, grid);
    for (int k = 0; k < grid.depth; ++k) {
      const auto row = f.index(0, k);
      EXPECT_EQ(std::memcmp(&f.value[row], &best.value[row], 35 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&f.slope_x[row], &best.slope_x[row], 35 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&f.slope_z[row], &best.slope_z[row], 35 * sizeof(float)), 0) << target;
    }
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
