#include "core/plates/macro_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/plates/macro_nodes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kFieldSeed = 77;

MacroField field_of(std::uint64_t seed) {
  PlateControls plates;
  plates.seed = seed;
  MacroControls macro;
  macro.seed = seed + 1000;
  return {plates, macro};
}

struct Sampled {
  ColumnGrid grid;
  std::vector<float> height, height_x, height_z, hilliness, hilliness_x, hilliness_z, floor, lift;

  std::size_t at(int i, int k) const {
    return static_cast<std::size_t>(k) * row_stride(grid) + static_cast<std::size_t>(i);
  }
  std::vector<float> column(int i, int k) const {
    const std::size_t n = at(i, k);
    return {height[n], height_x[n], height_z[n], hilliness[n], hilliness_x[n], hilliness_z[n], floor[n], lift[n]};
  }
};

Sampled sampled(const MacroField& field, const ColumnGrid& grid, MacroScratch& scratch) {
  Sampled s;
  s.grid = grid;
  for (auto* a : {&s.height, &s.height_x, &s.height_z, &s.hilliness, &s.hilliness_x, &s.hilliness_z, &s.floor, &s.lift})
    a->resize(sample_count(grid));
  field.sample(grid, scratch,
               {s.height.data(), s.height_x.data(), s.height_z.data(), s.hilliness.data(), s.hilliness_x.data(),
                s.hilliness_z.data(), s.floor.data(), s.lift.data()});
  return s;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(MacroField, GivesAColumnTheSameBitsInEveryGridAtEveryStepWhateverIsRemembered) {
  const MacroField field = field_of(1);
  test::Random random(kFieldSeed);
  MacroScratch used;
  for (int round = 0; round < test::rounds(120); ++round) {
    const std::int64_t step = std::int64_t{1} << random.whole(0, 12);
    const std::int64_t reach = round % 2 == 0 ? 2'000 : 1'000'000'000 / step;
    // Every fourth grid does not lie on the lattice of its own step.
    const std::int64_t off = round % 4 == 0 ? 3 : 0;
    const ColumnGrid grid{random.whole(-reach, reach) * step + off, random.whole(-reach, reach) * step,   step,
                          static_cast<int>(random.whole(1, 20)),    static_cast<int>(random.whole(1, 6)), 1.0};
    const Sampled many = sampled(field, grid, used);
    const int i = static_cast<int>(random.whole(0, grid.width - 1));
    const int k = static_cast<int>(random.whole(0, grid.depth - 1));
    MacroScratch fresh;
    const Sampled one = sampled(field, {grid.x_voxel + i * step, grid.z_voxel + k * step, 1, 1, 1, 1.0}, fresh);
    ASSERT_TRUE(same_bits(one.column(0, 0), many.column(i, k))) << "seed " << kFieldSeed << ", round " << round;
  }
}

TEST(MacroField, GivesTheSameBitsOnEveryTarget) {
  const MacroField field = field_of(2);
  for (const std::int64_t step : {1, 16, 64, 4096}) {
    const ColumnGrid grid{9'999'000 * step, -10'000'000 * step, step, 35, 20, 1.0};
    MacroScratch scratch;
    const Sampled best = sampled(field, grid, scratch);
    const int targets = test::for_each_simd_target([&](const char* target) {
      MacroScratch fresh;
      const Sampled here = sampled(field, grid, fresh);
      for (int k = 0; k < 20; ++k) {
        for (int i = 0; i < 35; ++i) ASSERT_TRUE(same_bits(here.column(i, k), best.column(i, k))) << target;
      }
    });
    EXPECT_GE(targets, 2);
  }
}

/// The node function itself, metre by metre: with voxels of 1/32 m nodes are 1 m apart.
ColumnGrid metre_nodes(const glm::i64vec2& at_m, int width, int depth) {
  return {at_m.x * kMacroNodeVoxels, at_m.y * kMacroNodeVoxels, kMacroNodeVoxels, width, depth, 1.0 / kMacroNodeVoxels};
}

TEST(MacroField, HasTheSlopesThatItsHeightsHave) {
  const MacroField field = field_of(3);
  test::Random random(kFieldSeed);
  MacroScratch scratch;
  double worst = 0;
  int steep = 0;
  for (int round = 0; round < test::rounds(400); ++round) {
    const glm::i64vec2 at{random.whole(-400'000, 400'000), random.whole(-400'000, 400'000)};
    const Sampled s = sampled(field, metre_nodes(at, 33, 33), scratch);
    // Over 32 m, where a float's rounding of some 0.1 mm hides nothing; the curvature's part is a tenth of the bound.
    const std::size_t middle = s.at(16, 16);
    const double x = static_cast<double>(s.height[s.at(32, 16)] - s.height[s.at(0, 16)]) / 32;
    const double z = static_cast<double>(s.height[s.at(16, 32)] - s.height[s.at(16, 0)]) / 32;
    const double slope = std::hypot(x, z);
    const double error =
        std::hypot(x - static_cast<double>(s.height_x[middle]), z - static_cast<double>(s.height_z[middle]));
    ASSERT_LT(error, 0.01 + 0.05 * slope) << "round " << round << " at " << at.x << ' ' << at.y;
    const double hilly_x = static_cast<double>(s.hilliness[s.at(32, 16)] - s.hilliness[s.at(0, 16)]) / 32;
    ASSERT_NEAR(hilly_x, static_cast<double>(s.hilliness_x[middle]), 4e-6);
    worst = std::max(worst, error);
    steep += slope > 0.1 ? 1 : 0;
  }
  EXPECT_GT(steep, test::rounds(20)) << "nothing had a slope";
  RecordProperty("worst_error", std::to_string(worst));
}

TEST(MacroField, InterpolatesSlopesThatItsColumnsHave) {
  const MacroField field = field_of(3);
  test::Random random(kFieldSeed);
  MacroScratch scratch;
  for (int round = 0; round < 100; ++round) {
    const std::int64_t x = random.whole(-400'000, 400'000);
    const std::int64_t z = random.whole(-400'000, 400'000);
    const Sampled s = sampled(field, {x, z, 1, 9, 9, 1.0}, scratch);
    const double slope_x = static_cast<double>(s.height[s.at(8, 4)] - s.height[s.at(0, 4)]) / 8;
    const double slope_z = static_cast<double>(s.height[s.at(4, 8)] - s.height[s.at(4, 0)]) / 8;
    ASSERT_NEAR(slope_x, static_cast<double>(s.height_x[s.at(4, 4)]), 4e-3);
    ASSERT_NEAR(slope_z, static_cast<double>(s.height_z[s.at(4, 4)]), 4e-3);
  }
}

/// Every fault of some plates: its middle, and both its vertices.
std::vector<glm::i64vec2> places_at_faults(const MacroField& field, std::int64_t square, int count) {
  std::vector<glm::i64vec2> out;
  Plate plate;
  std::vector<Site> sites;
  for (std::int64_t n = 0; static_cast<int>(out.size()) < count; ++n) {
    sites.clear();
    field.plates().sites().add_sites(square + n, square - 2 * n, sites);
    field.plates().build(sites[0].key, plate);
    for (const PlateFault& fault : plate.faults) {
      for (const float t : {0.0f, 0.5f, 1.0f}) {
        const float u = t * fault.length_m;
        out.push_back(plate.seat.site.at_m + fault.front_from_site +
                      glm::i64vec2{static_cast<std::int64_t>(fault.start_x + u * fault.along_x),
                                   static_cast<std::int64_t>(fault.start_z + u * fault.along_z)});
      }
    }
  }
  return out;
}

TEST(MacroField, HasNoStepAcrossFaultsAndVertices) {
  for (const std::uint64_t seed : {4U, 5U}) {
    const MacroField field = field_of(seed);
    MacroScratch scratch;
    for (const glm::i64vec2& place : places_at_faults(field, seed == 4 ? 0 : 30'000, 120)) {
      // 150 m along both diagonals of the place's surroundings and straight through it, a metre a step.
      const Sampled s = sampled(field, metre_nodes(place - glm::i64vec2{75, 2}, 150, 5), scratch);
      for (int k = 0; k < 5; ++k) {
        for (int i = 1; i < 150; ++i) {
          const std::size_t n = s.at(i, k);
          ASSERT_TRUE(std::isfinite(s.height[n]));
          ASSERT_LT(std::abs(s.height[n] - s.height[n - 1]), 2.5f) << place.x << ' ' << place.y;
          ASSERT_LT(std::abs(s.height_x[n] - s.height_x[n - 1]), 1.2f) << place.x << ' ' << place.y;
          ASSERT_LT(std::abs(s.hilliness[n] - s.hilliness[n - 1]), 0.004f);
        }
      }
    }
  }
}

TEST(MacroField, LooksAtEveryPlateThatHasAPart) {
  for (const std::uint64_t seed : {6U, 7U}) {
    const MacroField field = field_of(seed);
    const PlateBuilder& plates = field.plates();
    const ShelfTerms coast{1.0f / 6000, 3200, 150};
    PlateGather gather;
    PlateMemo memo;
    float least_share = 1;
    for (const glm::i64vec2& place : places_at_faults(field, 7, 60)) {
      NodeGroup group;
      for (std::size_t n = 0; n < kGroupNodes; ++n) {
        group.x[n] = static_cast<float>(256 * (n % 4));
        group.z[n] = static_cast<float>(256 * (n / 4));
      }
      const glm::i64vec2 size{768, 768};
      GroupSums near;
      for (const Site& site : gather.near(plates, place, place + size)) {
        const PlacedPlate placed{&memo.load(plates, site.key), site.at_m - place};
        if (can_share(placed, {0, 0}, glm::dvec2(size))) add_plate(placed, coast, group, near);
      }
      GroupSums all;
      std::vector<Site> sites;
      const std::int64_t x = plates.sites().square_of(place.x);
      const std::int64_t z = plates.sites().square_of(place.y);
      for (std::int64_t dz = -4; dz <= 4; ++dz) {
        for (std::int64_t dx = -4; dx <= 4; ++dx) plates.sites().add_sites(x + dx, z + dz, sites);
      }
      std::ranges::sort(sites, {}, &Site::key);
      for (const Site& site : sites) add_plate({&memo.load(plates, site.key), site.at_m - place}, coast, group, all);
      const auto same = [](const GroupJet& a, const GroupJet& b) { return a.v == b.v && a.x == b.x && a.z == b.z; };
      ASSERT_TRUE(same(near.share, all.share));
      for (std::size_t c = 0; c < kMacroChannels; ++c) ASSERT_TRUE(same(near.channel[c], all.channel[c])) << c;
      least_share = std::min(least_share, *std::ranges::min_element(all.share.v));
    }
    EXPECT_GT(least_share, 1e-4f) << "somewhere nearly nobody owns the ground";
  }
}

TEST(MacroField, HasTheSameDetailABillionMetresAway) {
  const MacroField field = field_of(8);
  MacroScratch scratch;
  // Bends over 64 m, averaged over many places so that land and sea, ranges and plains weigh alike.
  const auto roughness = [&](std::int64_t centre) {
    test::Random random(kFieldSeed);
    double sum = 0;
    int equal = 0;
    int count = 0;
    for (int n = 0; n < 300; ++n) {
      const glm::i64vec2 at{centre + random.whole(-600'000, 600'000), -centre + random.whole(-600'000, 600'000)};
      const Sampled s = sampled(field, {at.x, at.y, 1, 129, 1, 1.0}, scratch);
      for (int i = 32; i < 97; i += 8) {
        sum += std::abs(
            static_cast<double>(s.height[s.at(i + 32, 0)] - 2 * s.height[s.at(i, 0)] + s.height[s.at(i - 32, 0)]));
        equal += s.height[s.at(i, 0)] == s.height[s.at(i + 1, 0)] ? 1 : 0;
        ++count;
      }
    }
    EXPECT_LT(equal, count / 10) << "heights stand on stairs around " << centre;
    return sum / count;
  };
  const double ratio = roughness(1'000'000'000) / roughness(0);
  EXPECT_GT(ratio, 0.6);
  EXPECT_LT(ratio, 1.6);
}

TEST(MacroField, HasLandAndSeaWithPlainsAndSeaFloorAsTheTwoCommonHeights) {
  int land = 0;
  int count = 0;
  std::vector<int> histogram(60);  // of 50 m, from -1500 m
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const MacroField field = field_of(seed);
    MacroScratch scratch;
    for (std::int64_t z = 0; z < 4; ++z) {
      for (std::int64_t x = 0; x < 4; ++x) {
        // 512 km in all, a node every 2 km.
        const Sampled s = sampled(field, {x * 131'072, z * 131'072, 2048, 64, 64, 1.0}, scratch);
        for (int k = 0; k < 64; ++k) {
          for (int i = 0; i < 64; ++i) {
            const double height = static_cast<double>(s.height[s.at(i, k)]);
            ASSERT_GT(height, field.low_m());
            ASSERT_LT(height, field.high_m());
            ASSERT_GE(s.lift[s.at(i, k)], 0.0f);
            ++count;
            land += height > 0 ? 1 : 0;
            ++histogram[static_cast<std::size_t>(std::clamp((height + 1500) / 50, 0.0, 59.0))];
          }
        }
      }
    }
  }
  EXPECT_NEAR(static_cast<double>(land) / count, 0.40, 0.08);
  const auto peak = [&](int from_m, int to_m) {
    const auto at = [&](int m) { return histogram.begin() + (m + 1500) / 50; };
    return *std::max_element(at(from_m), at(to_m));
  };
  const int sea_floor = peak(-500, -200);
  const int plains = peak(50, 400);
  const int between = *std::min_element(histogram.begin() + (1500 - 200) / 50, histogram.begin() + (1500 + 50) / 50);
  EXPECT_GT(sea_floor, 3 * between);
  EXPECT_GT(plains, 3 * between / 2);
}

}  // namespace
}  // namespace talus
