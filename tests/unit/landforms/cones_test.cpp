#include "core/landforms/cones.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kConeSeed = 1883;

/// Level ground at sea level with cones on it.
struct Ground {
  ColumnGrid grid;
  std::vector<float> height, slope_x, slope_z, fade, strength, hilliness, workspace;

  Ground(std::span<const Cone> cones, const ColumnGrid& at) : grid(at) {
    const std::size_t count = sample_count(grid);
    for (auto* array : {&height, &slope_x, &slope_z, &fade, &strength, &hilliness}) array->resize(count);
    workspace.resize(kConeArrays * count);
    raise_cones({}, cones, grid, {height, slope_x, slope_z}, {fade, strength, hilliness}, workspace);
    heap_cinders({}, cones, grid, {height, slope_x, slope_z}, workspace);
  }
  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(k) * row_stride(grid) + static_cast<std::size_t>(i);
  }
  double at(int i, int k) const { return static_cast<double>(height[index(i, k)]); }
};

/// 151 x 151 columns around a cone, out to `reach` radii.
ColumnGrid around(const Cone& cone, double reach) {
  const double step_m = reach * static_cast<double>(cone.radius_m) / 75;
  const auto step = static_cast<std::int64_t>(step_m * 4);
  return {static_cast<std::int64_t>(cone.x_m * 4) - 75 * step,
          static_cast<std::int64_t>(cone.z_m * 4) - 75 * step,
          step,
          151,
          151,
          0.25};
}

Cone volcano() {
  return {40'000'000, -8'000, 2400, 800, 0.1f, 70, 1, 0.6f, false};
}
Cone cinder_cone() {
  return {-1'000, 500, 210, 75, 0.3f, 18, 1, 0, true};
}

TEST(Cones, HaveTheirHeightTheirCraterAndAboutTheirRadius) {
  for (const Cone& cone : {volcano(), cinder_cone()}) {
    const Ground ground({&cone, 1}, around(cone, 1.5));
    const double highest = static_cast<double>(*std::ranges::max_element(ground.height));
    const auto height_m = static_cast<double>(cone.height_m);
    EXPECT_LE(highest, height_m);
    EXPECT_GT(highest, 0.6 * height_m);
    EXPECT_LT(ground.at(75, 75), highest - 0.5 * static_cast<double>(cone.crater_m)) << "no crater";
    EXPECT_GE(*std::ranges::min_element(ground.height), 0.0f);
    // Area of the ground that has risen, as the radius of a circle.
    const double step_m = static_cast<double>(ground.grid.step_voxel) * ground.grid.voxel_m;
    const auto risen = std::ranges::count_if(ground.height, [](float h) { return h > 0; });
    const double radius_m = std::sqrt(static_cast<double>(risen) / 3.14159265) * step_m;
    EXPECT_NEAR(radius_m / static_cast<double>(cone.radius_m), 1.0, 0.15);
  }
}

TEST(Cones, HaveTheSlopesThatTheirHeightsHave) {
  for (const Cone& cone : {volcano(), cinder_cone()}) {
    const std::int64_t x = static_cast<std::int64_t>(cone.x_m + static_cast<double>(cone.radius_m) * 0.3) * 4;
    const Ground g({&cone, 1}, {x, static_cast<std::int64_t>(cone.z_m) * 4 + 90, 1, 100, 100, 0.25});
    double worst = 0;
    for (int k = 1; k < 99; ++k) {
      for (int i = 1; i < 99; ++i) {
        const double dx = (g.at(i + 1, k) - g.at(i - 1, k)) / 0.5 - static_cast<double>(g.slope_x[g.index(i, k)]);
        const double dz = (g.at(i, k + 1) - g.at(i, k - 1)) / 0.5 - static_cast<double>(g.slope_z[g.index(i, k)]);
        worst = std::max({worst, std::abs(dx), std::abs(dz)});
      }
    }
    EXPECT_LT(worst, 2e-3) << "against slopes of about 0.4";
  }
}

TEST(Cones, TouchNothingBeyondTheirReach) {
  const Cone cone = volcano();
  const double reach_m = kConeReach * static_cast<double>(cone.radius_m);
  const std::int64_t x = static_cast<std::int64_t>(cone.x_m + reach_m) + 1;
  const Ground g({&cone, 1}, {x, static_cast<std::int64_t>(cone.z_m), 1, 20, 1, 1});
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(g.height[g.index(i, 0)], 0.0f);
    EXPECT_EQ(g.fade[g.index(i, 0)], 0.0f);
    EXPECT_EQ(g.strength[g.index(i, 0)], 0.0f);
  }
}

TEST(Cones, AreFoundFromEveryColumnTheyReach) {
  const ConeControls controls;
  test::Random random(kConeSeed);
  std::vector<ConeSite> all;
  std::vector<ConeSite> near;
  std::vector<Cone> cones;
  for (int round = 0; round < 40; ++round) {
    const std::int64_t reach = round % 2 == 0 ? 100'000 : 1'000'000'000;
    const ColumnGrid wide{random.whole(-reach, reach), random.whole(-reach, reach), 400, 160, 160, 1};
    find_cone_sites(controls, wide, all);
    ASSERT_FALSE(all.empty());
    for (const ConeSite& site : all) {
      cones.clear();
      grow_cones(controls, site, round % 3 == 0 ? -300.0f : 100.0f, 0.7f, cones);
      for (const Cone& cone : cones) {
        const auto at = [&](double centre_m) {
          const double far_m = kConeReach * static_cast<double>(cone.radius_m);
          return static_cast<std::int64_t>(centre_m + random.real(-0.7, 0.7) * far_m);
        };
        find_cone_sites(controls, {at(cone.x_m), at(cone.z_m), 1, 1, 1, 1}, near);
        ASSERT_TRUE(std::ranges::any_of(near, [&](const ConeSite& s) { return s.hash == site.hash; }))
            << "seed " << kConeSeed << ", round " << round;
      }
    }
  }
}

TEST(Cones, StandAcrossTheSeamOfAWorldThatWrapsAsAnywhere) {
  ConeControls controls;
  constexpr std::int64_t period = 131'072;
  std::vector<ConeSite> here;
  std::vector<ConeSite> there;
  std::vector<Cone> cones;
  int across = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    controls.seed = seed;
    // Half of the grid lies before the seam, half behind it; the other one is three turns away.
    const ColumnGrid at_seam{-100 * 40, static_cast<std::int64_t>(seed) * 50'000, 40, 200, 200, 1, period};
    ColumnGrid turned = at_seam;
    turned.x_voxel += 3 * period;
    find_cone_sites(controls, at_seam, here);
    find_cone_sites(controls, turned, there);
    ASSERT_EQ(here.size(), there.size()) << seed;
    for (std::size_t n = 0; n < here.size(); ++n) {
      ASSERT_EQ(here[n].hash, there[n].hash) << seed;
      ASSERT_EQ(here[n].x_m + 3.0 * static_cast<double>(period), there[n].x_m) << seed;
      ASSERT_EQ(here[n].z_m, there[n].z_m) << seed;
      cones.clear();
      grow_cones(controls, here[n], -320.0f, 0.1f, cones);
      if (cones.empty()) continue;
      const double foot_m = static_cast<double>(cones[0].radius_m);
      if (std::abs(cones[0].x_m) > 0.7 * foot_m) continue;
      // Columns two metres to either side of the seam, through the middle: one cone, without a step.
      const ColumnGrid fine{-2, static_cast<std::int64_t>(cones[0].z_m), 1, 5, 1, 1, period};
      const Ground ground(cones, fine);
      ASSERT_GT(ground.at(2, 0), 0.0) << seed;
      for (int i = 0; i < 4; ++i) ASSERT_LT(std::abs(ground.at(i + 1, 0) - ground.at(i, 0)), 2.0) << seed;
      ++across;
    }
  }
  EXPECT_GT(across, 10);
}

TEST(Cones, StandInProvincesAndNotInRows) {
  const ConeControls controls;
  std::vector<ConeSite> sites;
  std::array<int, 8> within{};  // where sites lie in their cells, along x
  int most = 0;
  int least = 1'000;
  int all = 0;
  for (std::int64_t tile = 0; tile < 40; ++tile) {
    // 12 x 12 cells.
    find_cone_sites(controls, {tile * 1'000'000, -tile * 2'000'000, 600, 160, 160, 1}, sites);
    int here = 0;
    std::vector<Cone> cones;
    for (const ConeSite& site : sites) {
      cones.clear();
      grow_cones(controls, site, -320.0f, 0.1f, cones);
      if (cones.empty()) continue;
      ++here;
      const double cell = site.x_m / controls.cell_m;
      ++within[static_cast<std::size_t>((cell - std::floor(cell)) * 7.999)];
    }
    most = std::max(most, here);
    least = std::min(least, here);
    all += here;
  }
  EXPECT_GT(most, 2 * least) << "provinces differ";
  EXPECT_NEAR(all / 40.0, 144 * controls.sea_share, 0.3 * 144 * controls.sea_share);
  // No lane between rows is emptier than half of the mean, and none twice as full.
  EXPECT_GT(*std::ranges::min_element(within), all / 16);
  EXPECT_LT(*std::ranges::max_element(within), all / 4);
}

TEST(Cones, StandOnLandAndOnTheSeaFloorButNotOnShores) {
  const ConeControls controls;
  std::vector<ConeSite> sites;
  std::vector<Cone> cones;
  int volcanoes = 0;
  int fields = 0;
  int seamounts = 0;
  for (std::int64_t tile = 0; tile < 20; ++tile) {
    find_cone_sites(controls, {tile * 1'000'000, 0, 500, 160, 160, 1}, sites);
    for (const ConeSite& site : sites) {
      cones.clear();
      grow_cones(controls, site, -60.0f, 0.5f, cones);
      ASSERT_TRUE(cones.empty());
      grow_cones(controls, site, 60.0f, 0.1f, cones);
      const bool has_volcano = std::ranges::any_of(cones, [](const Cone& c) { return !c.is_cinder; });
      volcanoes += has_volcano ? 1 : 0;
      fields += !cones.empty() && !has_volcano ? 1 : 0;
      double total = 0;
      for (const Cone& cone : cones) total = std::max(total, static_cast<double>(cone.height_m));
      ASSERT_LE(total, cones_bound(controls));
      cones.clear();
      grow_cones(controls, site, -320.0f, 0.1f, cones);
      seamounts += cones.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(volcanoes, 50);
  EXPECT_GT(fields, volcanoes) << "plains have fields of cinder cones rather than volcanoes";
  EXPECT_GT(seamounts, volcanoes + fields);
}

TEST(Cones, GiveTheSameBitsOnEveryTarget) {
  const std::vector<Cone> cones{volcano(), cinder_cone()};
  ColumnGrid grid = around(cones[0], 1.4);
  grid.depth = 90;
  const Ground best(cones, grid);
  const int targets = test::for_each_simd_target([&](const char* target) {
    const Ground g(cones, grid);
    for (int k = 0; k < grid.depth; ++k) {
      const auto row = g.index(0, k);
      EXPECT_EQ(std::memcmp(&g.height[row], &best.height[row], 151 * sizeof(float)), 0) << target;
      EXPECT_EQ(std::memcmp(&g.fade[row], &best.fade[row], 151 * sizeof(float)), 0) << target;
    }
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
