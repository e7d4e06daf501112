// Whether every rock gets the share of a layer's land that its probability says: chi-square over large areas.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "core/world/terms.hpp"
#include "core/world/world_function.hpp"
#include "tests/support/random.hpp"

namespace talus {
namespace {

struct Chi {
  double sum = 0;
  int freedom = 0;
};

/// Draws places of one layer all over a square of land and compares its rocks with their probabilities.
void add_layer(const WorldFunction& world, test::Random& random, LayerPlace place, double origin_m, Chi& chi) {
  constexpr int kPlaces = 20'000;
  constexpr float kStack_m = 3'600;
  const LayerSet& set = world.terms().strata->set(place.set);
  const Layer& layer = set.layer(place.index);
  const float height = kStack_m - 0.5f * (set.top_m(place.index) + set.top_m(place.index + 1));
  std::array<double, kMaterials.size()> expected{};
  std::array<double, kMaterials.size()> found{};
  double below = 0;
  for (std::size_t n = 0; n < kRocksPerLayer; ++n) {
    const auto share = static_cast<double>(layer.cumulative[n]);
    expected[static_cast<std::size_t>(layer.rocks[n])] += (share - below) * kPlaces;
    below = share;
  }
  for (int n = 0; n < kPlaces; ++n) {
    const glm::i64vec2 voxel(static_cast<std::int64_t>(origin_m + random.real(-4e6, 4e6)),
                             static_cast<std::int64_t>(random.real(-4e6, 4e6)));
    const Material rock = world.rock({kStack_m, static_cast<float>(place.set), height, voxel});
    found[static_cast<std::size_t>(rock)] += 1;
  }
  int rocks = 0;
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (expected[n] == 0) {
      ASSERT_EQ(found[n], 0) << "a rock that the layer does not hold: " << kMaterials[n].name;
      continue;
    }
    chi.sum += (found[n] - expected[n]) * (found[n] - expected[n]) / expected[n];
    ++rocks;
  }
  chi.freedom += rocks - 1;
}

/// How many standard deviations a sum is above what chance gives: chi-square has mean f and variance 2 f.
double excess(const Chi& chi) {
  return (chi.sum - chi.freedom) / std::sqrt(2.0 * chi.freedom);
}

TEST(RockShares, MatchTheProbabilitiesOfTheirLayersNearTheOriginAndFarOut) {
  const WorldFunction world{Manifest()};
  for (const double origin_m : {0.0, 1e9}) {
    constexpr std::uint64_t kShareSeed = 4711;
    test::Random random(kShareSeed);
    Chi chi;
    for (int n = 0; n < 60; ++n) {
      const LayerPlace place{n % world.terms().strata->sets(), static_cast<int>(random.whole(0, kLayers - 1))};
      add_layer(world, random, place, origin_m, chi);
    }
    EXPECT_LT(excess(chi), 4.5) << "chi-square " << chi.sum << " of " << chi.freedom << ", seed " << kShareSeed;
    EXPECT_GT(excess(chi), -4.5) << "too even for chance: " << chi.sum << " of " << chi.freedom;
    RecordProperty("chi_square", std::to_string(chi.sum) + " of " + std::to_string(chi.freedom));
  }
}

TEST(RockShares, OfAWrappedWorldMatchThemAsWell) {
  Manifest manifest;
  manifest.values[parameter_index("world.wrap_m")] = 1'048'576;
  const WorldFunction world(manifest);
  test::Random random(5);
  Chi chi;
  for (int n = 0; n < 20; ++n) add_layer(world, random, {n % 12, 100 + 90 * n}, 0, chi);
  EXPECT_LT(excess(chi), 4.5) << chi.sum << " of " << chi.freedom;
}

}  // namespace
}  // namespace talus
