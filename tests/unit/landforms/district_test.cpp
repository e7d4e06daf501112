#include "core/landforms/district.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/landforms/dunes.hpp"
#include "core/landforms/karst.hpp"
#include "core/landforms/tables.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

using Array = std::vector<float>;

/// A grid with a gently sloping ground, a weight that rises from 0 to 1 along x, and room to work.
struct Land {
  ColumnGrid grid;
  Array height, slope_x, slope_z, weight, weight_x, weight_z, fade, rill_x, rill_z, workspace;

  explicit Land(const ColumnGrid& at, bool full = false) : grid(at) {
    const std::size_t count = sample_count(at);
    for (Array* a : {&height, &slope_x, &slope_z, &weight, &weight_x, &weight_z, &fade, &rill_x, &rill_z})
      a->resize(count);
    workspace.resize(8 * count);
    for (int k = 0; k < at.depth; ++k) {
      for (int i = 0; i < at.width; ++i) {
        const std::size_t p = index(i, k);
        // Weights of a ramp 2 km long at the origin of every 4 km.
        const double x = static_cast<double>(at.x_voxel + i * at.step_voxel) * at.voxel_m;
        const double ramp = (x - std::floor(x / 4000) * 4000 - 1000) / 2000;
        weight[p] = full ? 1.0f : static_cast<float>(std::clamp(ramp, 0.0, 1.0));
        weight_x[p] = !full && ramp > 0 && ramp < 1 ? 1.0f / 2000 : 0.0f;
        height[p] = 40.0f;
      }
    }
  }
  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(k) * row_stride(grid) + static_cast<std::size_t>(i);
  }
  JetArrays weights() { return {weight, weight_x, weight_z}; }
  GroundArrays ground() { return {height, slope_x, slope_z}; }
};

using Landform = std::function<void(Land&)>;

struct Named {
  const char* name;
  Landform apply;
  glm::dvec2 bound;  ///< of a ground of 40 m
  double slope_error;
};

std::vector<Named> landforms() {
  const glm::dvec2 flat{40, 40};
  return {
      {"badlands",
       [](Land& l) {
         badlands({}, l.grid, l.weights(), l.ground(), {l.fade, l.rill_x, l.rill_z}, l.workspace);
       },
       badlands_bound({}, flat), 2e-3},
      {"mesas", [](Land& l) { mesas({}, l.grid, l.weights(), l.ground(), l.workspace); }, mesas_bound({}, flat), 5e-3},
      {"karst", [](Land& l) { karst({}, l.grid, l.weights(), l.ground(), l.workspace); }, karst_bound({}, flat), 2e-2},
      {"dunes", [](Land& l) { dunes({}, l.grid, l.weights(), l.ground(), l.workspace); }, dunes_bound({}, flat), 0.5}};
}

TEST(Landforms, KeepEveryBitWhereTheirDistrictHasNoWeight) {
  for (const Named& form : landforms()) {
    Land land({0, 500, 25, 160, 40, 1.0});
    form.apply(land);
    int still = 0;
    double moved = 0;
    for (int k = 0; k < 40; ++k) {
      for (int i = 0; i < 160; ++i) {
        const std::size_t p = land.index(i, k);
        if (land.weight[p] == 0) {
          ASSERT_EQ(land.height[p], 40.0f) << form.name;
          ASSERT_EQ(land.slope_x[p], 0.0f) << form.name;
          ++still;
        }
        moved = std::max(moved, std::abs(static_cast<double>(land.height[p]) - 40.0));
      }
    }
    EXPECT_GT(still, 500) << form.name;
    EXPECT_GT(moved, 10) << form.name;
  }
}

TEST(Landforms, DependOnThePointAndNotOnTheGridAndStayWithinTheirBounds) {
  for (const Named& form : landforms()) {
    Land whole({999'999'000, -500, 8, 128, 96, 1.0});
    Land part({999'999'000 + 8 * 37, -500 + 8 * 11, 8, 21, 13, 1.0});
    form.apply(whole);
    form.apply(part);
    for (int k = 0; k < 13; ++k) {
      for (int i = 0; i < 21; ++i) {
        ASSERT_EQ(part.height[part.index(i, k)], whole.height[whole.index(i + 37, k + 11)]) << form.name;
        ASSERT_EQ(part.slope_z[part.index(i, k)], whole.slope_z[whole.index(i + 37, k + 11)]) << form.name;
      }
    }
    for (int k = 0; k < 96; ++k) {
      for (int i = 0; i < 128; ++i) {
        const double height = static_cast<double>(whole.height[whole.index(i, k)]);
        ASSERT_GE(height, form.bound.x) << form.name;
        ASSERT_LE(height, form.bound.y) << form.name;
      }
    }
  }
}

TEST(Landforms, HaveTheSlopesThatTheirHeightsHave) {
  for (const Named& form : landforms()) {
    Land land({1'500, 2'000, 1, 160, 120, 0.25});
    form.apply(land);
    double worst = 0;
    double mean = 0;
    for (int k = 1; k < 119; ++k) {
      for (int i = 1; i < 159; ++i) {
        const auto h = [&](int a, int b) { return static_cast<double>(land.height[land.index(a, b)]); };
        const double dx = (h(i + 1, k) - h(i - 1, k)) / 0.5 - static_cast<double>(land.slope_x[land.index(i, k)]);
        const double dz = (h(i, k + 1) - h(i, k - 1)) / 0.5 - static_cast<double>(land.slope_z[land.index(i, k)]);
        worst = std::max({worst, std::abs(dx), std::abs(dz)});
        mean += std::abs(dx) + std::abs(dz);
      }
    }
    EXPECT_LT(worst, form.slope_error) << form.name;
    EXPECT_LT(mean / (2 * 118 * 158), form.slope_error / 4) << form.name;
  }
}

TEST(Landforms, GiveTheSameBitsOnEveryTarget) {
  const ColumnGrid grid{-999'999'000, 1'234'567, 7, 35, 35, 1.0};
  std::vector<Array> best;
  for (const Named& form : landforms()) {
    Land land(grid);
    form.apply(land);
    best.push_back(land.height);
    best.push_back(land.slope_x);
  }
  const int targets = test::for_each_simd_target([&](const char* target) {
    std::size_t n = 0;
    for (const Named& form : landforms()) {
      Land land(grid);
      form.apply(land);
      EXPECT_EQ(land.height, best[n++]) << form.name << ' ' << target;
      EXPECT_EQ(land.slope_x, best[n++]) << form.name << ' ' << target;
    }
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

/// Weights over a grid of low, dry, flat land.
struct Weighed {
  ColumnGrid grid;
  Array height, slope, hilliness, workspace;
  std::array<std::array<Array, 3>, kDistricts> arrays;
  Array folded;
  DistrictWeights weights;
  Weighed(const ColumnGrid& at, float height_m, float hilly) : grid(at) {
    const std::size_t count = sample_count(at);
    height.assign(count, height_m);
    slope.assign(count, 0.0f);
    hilliness.assign(count, hilly);
    workspace.resize(kDistrictArrays * count);
    for (std::size_t k = 0; k < kDistricts; ++k) {
      for (Array& a : arrays[k]) a.resize(count);
      weights.of[k] = {arrays[k][0], arrays[k][1], arrays[k][2]};
    }
    folded.resize(count);
    weights.folded = folded;
    district_weights({}, grid, {height, slope, slope}, hilliness, workspace, weights);
  }
};

TEST(Districts, HaveTheSharesThatTheManifestSays) {
  std::array<double, kDistricts> low{};
  std::array<double, kDistricts> high{};
  int points = 0;
  for (int tile = 0; tile < 40; ++tile) {
    const ColumnGrid grid{tile * 3'000'000, -tile * 7'000'000, 1'500, 100, 100, 1.0};
    const Weighed plain(grid, 60, 0);
    const Weighed range(grid, 900, 1);
    for (std::size_t k = 0; k < 100; ++k) {
      for (std::size_t i = 0; i < 100; ++i, ++points) {
        double sum = 0;
        for (std::size_t n = 0; n < kDistricts; ++n) {
          const auto w = static_cast<double>(plain.weights.of[n].v[k * row_stride(grid) + i]);
          ASSERT_GE(w, 0);
          low[n] += w;
          sum += w;
          high[n] += static_cast<double>(range.weights.of[n].v[k * row_stride(grid) + i]);
        }
        ASSERT_LE(sum, 1.0001);
      }
    }
  }
  const DistrictControls controls;
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_NEAR(low[n] / points, controls.share[n], 0.02) << kDistrictNames[n];
    EXPECT_EQ(high[n], 0) << kDistrictNames[n] << " in high ranges";
  }
  EXPECT_NEAR(high[4] / points, controls.share[4], 0.03);
  EXPECT_EQ(low[4], 0) << "glaciers on a plain";
}

TEST(Districts, FlattenLayersWhateverTheGroundAndWhollyBeforeTablesBegin) {
  double table = 0;
  for (int tile = 0; tile < 20; ++tile) {
    const ColumnGrid grid{tile * 3'000'000, -tile * 7'000'000, 150, 100, 100, 1.0};
    const Weighed dry(grid, 60, 0);
    const Weighed shore(grid, -3, 0);
    const Weighed range(grid, 900, 1);
    ASSERT_EQ(dry.folded, shore.folded);
    ASSERT_EQ(dry.folded, range.folded);
    for (std::size_t k = 0; k < 100; ++k) {
      for (std::size_t i = 0; i < 100; ++i) {
        const std::size_t at = k * row_stride(grid) + i;
        const auto w = static_cast<double>(dry.weights[District::kMesas].v[at]);
        const auto folded = static_cast<double>(dry.folded[at]);
        // 0.15 is what is left of folds in table land; the fringe of a border may lie before the calm noise's.
        ASSERT_GE(folded, 0.15 * 0.45 - 1e-6);
        ASSERT_LE(folded, 1.0);
        if (w > 0.97) {
          ASSERT_LT(folded, 0.45);
        }
        table += w;
      }
    }
  }
  EXPECT_GT(table, 1'000);
}

TEST(Districts, AreFoundByTheirShareOfTheNoise) {
  EXPECT_NEAR(district_threshold(0.5), 0, 1e-9);
  EXPECT_NEAR(district_threshold(0.2), -district_threshold(0.8), 1e-9);
  EXPECT_GT(district_threshold(0.01), district_threshold(0.02));
}

}  // namespace
}  // namespace talus
