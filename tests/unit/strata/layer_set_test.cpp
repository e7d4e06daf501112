#include "core/strata/layer_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/strata/layer_search.hpp"
#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

TEST(LayerSet, FillsItsStackFromTopToBottom) {
  for (const std::uint64_t seed : {1ULL, 2ULL, 77ULL}) {
    const LayerSet set(seed);
    EXPECT_EQ(set.top_m(0), 0.0f);
    EXPECT_EQ(set.top_m(kLayers), kStackDepth);
    for (int i = 0; i < kLayers; ++i) ASSERT_LT(set.top_m(i), set.top_m(i + 1)) << i;
  }
}

TEST(LayerSet, FindsTheLayerThatABinarySearchFinds) {
  const LayerSet set(5);
  std::vector<float> tops;
  for (int i = 0; i < kLayers; ++i) tops.push_back(set.top_m(i));
  const auto slow = [&](float depth) {
    const auto at = std::ranges::upper_bound(tops, depth);
    return std::max(static_cast<int>(at - tops.begin()) - 1, 0);
  };
  test::Random random(9);
  for (int n = 0; n < 100'000; ++n) {
    const auto depth = static_cast<float>(random.real(-100, static_cast<double>(kStackDepth) + 100));
    ASSERT_EQ(set.index_at(depth), slow(depth)) << depth;
  }
  for (int i = 0; i < kLayers; ++i) {
    ASSERT_EQ(set.index_at(set.top_m(i)), i);
    ASSERT_EQ(set.index_at(std::nextafter(set.top_m(i + 1), 0.0f)), i);
  }
}

TEST(LayerSearch, FindsForManyDepthsWhatOneSearchFindsOnEveryTarget) {
  const LayerSet set(5);
  const LayerSearch search(set);
  test::Random random(10);
  std::vector<float> depths;
  for (int n = 0; n < 20'003; ++n) {
    depths.push_back(static_cast<float>(random.real(-100, static_cast<double>(kStackDepth) + 100)));
  }
  for (int i = 0; i <= kLayers; ++i) depths.push_back(set.top_m(i));
  test::for_each_simd_target([&](const char* target) {
    std::vector<std::int32_t> layers(depths.size());
    search.find(depths, layers);
    for (std::size_t n = 0; n < depths.size(); ++n) ASSERT_EQ(layers[n], set.index_at(depths[n])) << target;
  });
}

TEST(LayerSet, GivesEachRockItsProbability) {
  const LayerSet set(5);
  test::Random random(3);
  for (const int index : {0, 17, 900, kLayers - 1}) {
    const Layer& layer = set.layer(index);
    int first = 0;
    constexpr int kDraws = 40'000;
    for (int n = 0; n < kDraws; ++n)
      first += set.rock_at(index, static_cast<float>(random.unit())) == layer.rocks[0] ? 1 : 0;
    // Four standard deviations of a binomial share are at most 4 * 0.5 / sqrt(40000) = 0.01.
    EXPECT_NEAR(static_cast<double>(first) / kDraws, static_cast<double>(layer.cumulative[0]), 0.01);
  }
}

}  // namespace
}  // namespace talus
