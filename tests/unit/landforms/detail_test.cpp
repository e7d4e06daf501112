#include "core/landforms/detail.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

/// An even slope of one kind, 300 m above the sea unless it says otherwise.
struct Slope {
  float rise = 0.1f;
  float hilliness = 0.6f;
  float ridge = 0;
  float cliff_m = 0;
  float beach = 0;
  float height_m = 300;
};

struct Patch {
  ColumnGrid grid;
  std::vector<float> hilliness, ridge, cliff, beach, height, slope_x, slope_z, workspace;

  Patch(const Slope& s, const ColumnGrid& at, const DetailControls& controls = {}) : grid(at) {
    const std::size_t count = sample_count(grid);
    for (auto* array : {&hilliness, &ridge, &cliff, &beach, &height, &slope_x, &slope_z}) array->resize(count);
    workspace.resize(kDetailArrays * count);
    std::ranges::fill(hilliness, s.hilliness);
    std::ranges::fill(ridge, s.ridge);
    std::ranges::fill(cliff, s.cliff_m);
    std::ranges::fill(beach, s.beach);
    std::ranges::fill(slope_x, s.rise);
    std::ranges::fill(height, s.height_m);  // the plane itself is left out: what is added is what counts
    add_detail(controls, grid, {hilliness, ridge, cliff, beach}, {height, slope_x, slope_z}, workspace);
    for (float& h : height) h -= s.height_m;
  }
  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(k) * row_stride(grid) + static_cast<std::size_t>(i);
  }
  double at(int i, int k) const { return static_cast<double>(height[index(i, k)]); }
  /// Root mean square of the steps from column to column.
  double roughness() const {
    double sum2 = 0;
    int steps = 0;
    for (int k = 0; k < grid.depth; ++k) {
      for (int i = 1; i < grid.width; ++i, ++steps) sum2 += std::pow(at(i, k) - at(i - 1, k), 2);
    }
    return std::sqrt(sum2 / steps);
  }
};

constexpr ColumnGrid kGrid{7'000, -3'000, 1, 150, 150, 1};

TEST(Detail, IsCalmOnMeadowsAndBeachesAndRoughOnScreeAndWalls) {
  const double meadow = Patch({.rise = 0.08f, .hilliness = 0.1f}, kGrid).roughness();
  const double beach = Patch({.rise = 0.05f, .hilliness = 0.1f, .beach = 1, .height_m = 1}, kGrid).roughness();
  const double scree = Patch({.rise = 0.7f}, kGrid).roughness();
  const double wall = Patch({.rise = 2.5f}, kGrid).roughness();
  EXPECT_LT(meadow, 0.08) << "metres of unevenness a step";
  EXPECT_LT(beach, 0.25 * meadow);
  EXPECT_GT(scree, 3 * meadow);
  EXPECT_GT(wall, 3 * meadow);
}

TEST(Detail, StrewsBouldersOnScreeInStreamsAndBelowSeaCliffs) {
  DetailControls smooth;
  smooth.rough_plain_m = smooth.rough_hill_m = smooth.joint_m = 0;
  const auto covered = [&](const Slope& slope) {
    const Patch p(slope, kGrid, smooth);
    double count = 0;
    for (int k = 0; k < 150; ++k) {
      for (int i = 0; i < 150; ++i) count += p.at(i, k) > 0.2 ? 1 : 0;
    }
    return count / (150 * 150);
  };
  EXPECT_EQ(covered({.rise = 0.1f}), 0);
  EXPECT_EQ(covered({.rise = 0.7f, .hilliness = 0.05f}), 0) << "plains have no scree";
  for (const Slope& stony :
       {Slope{.rise = 0.7f}, Slope{.rise = 0.3f, .ridge = -0.95f}, Slope{.rise = 0.3f, .cliff_m = 50, .height_m = 0}}) {
    EXPECT_GT(covered(stony), 0.05);
    EXPECT_LT(covered(stony), 0.5);
  }
}

TEST(Detail, HasTheSlopesThatItsHeightsHave) {
  for (const float rise : {0.1f, 0.7f, 2.5f}) {
    // Steps of 1/16 m. Rims and tops of boulders and creases of joints are kinks, met by few columns.
    const Patch p({.rise = rise}, {90'000, 50'000, 1, 150, 150, 0.0625});
    int kinks = 0;
    double sum = 0;
    for (int k = 1; k < 149; ++k) {
      for (int i = 1; i < 149; ++i) {
        const auto slope_x = static_cast<double>(p.slope_x[p.index(i, k)]) - static_cast<double>(rise);
        const auto slope_z = static_cast<double>(p.slope_z[p.index(i, k)]);
        const double dx = (p.at(i + 1, k) - p.at(i - 1, k)) / 0.125 - slope_x;
        const double dz = (p.at(i, k + 1) - p.at(i, k - 1)) / 0.125 - slope_z;
        const double error = std::max(std::abs(dx), std::abs(dz));
        kinks += error > 0.02 ? 1 : 0;
        sum += error > 0.02 ? 0 : error;
      }
    }
    EXPECT_LT(kinks, 148 * 148 / 25) << rise;
    EXPECT_LT(sum / (148 * 148), 4e-3) << rise;
  }
}

TEST(Detail, StaysWithinItsBound) {
  const DetailControls controls;
  for (const float rise : {0.1f, 0.7f, 6.0f}) {
    const Patch p({.rise = rise, .hilliness = 1}, {0, 0, 5, 150, 150, 1}, controls);
    const auto [low, high] = std::ranges::minmax(p.height);
    EXPECT_LE(static_cast<double>(std::max(-low, high)), detail_bound(controls));
  }
}

TEST(Detail, DependsOnThePointAndNotOnTheGridOrTarget) {
  const Slope slope{.rise = 0.75f};
  const ColumnGrid grid{-4'000'000'003, 1'234, 4, 40, 20, 1};
  const Patch whole(slope, grid);
  const Patch part(slope, {grid.x_voxel + 4 * 11, grid.z_voxel + 4 * 7, 4, 3, 2, 1});
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(part.at(i, k), whole.at(i + 11, k + 7));
  }
  const int targets = test::for_each_simd_target([&](const char* target) {
    const Patch p(slope, grid);
    for (int k = 0; k < grid.depth; ++k) {
      const auto row = p.index(0, k);
      EXPECT_EQ(std::memcmp(&p.height[row], &whole.height[row], 40 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&p.slope_z[row], &whole.slope_z[row], 40 * sizeof(float)), 0) << target;
    }
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
