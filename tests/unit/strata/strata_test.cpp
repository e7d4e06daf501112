#include "core/strata/strata.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/strata/hardness_profile.hpp"
#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

constexpr std::size_t kWidth = 96;

/// One row of columns of one stack, at heights that rise along it.
struct Row {
  std::vector<float> stack, choice, district, fashion, relief_x, relief_z, height, slope_x, slope_z, hardness;
  Row(float stack_m, float set_choice, float low_m, float step_m) {
    for (auto* a : {&stack, &choice, &district, &fashion, &relief_x, &relief_z, &height, &slope_x, &slope_z, &hardness})
      a->resize(kWidth);
    for (std::size_t i = 0; i < kWidth; ++i) {
      stack[i] = stack_m;
      choice[i] = set_choice;
      district[i] = 0.6f;
      fashion[i] = 0.5f;
      relief_x[i] = 0.9f;
      height[i] = low_m + step_m * static_cast<float>(i);
      slope_x[i] = 1.0f;
    }
  }
  StrataRow place() const { return {stack.data(), choice.data(), district.data(), fashion.data(), kWidth}; }
  void ledge(const Strata& strata) {
    strata.ledge_row(place(), relief_x.data(), relief_z.data(), height.data(), slope_x.data(), slope_z.data());
  }
};

Strata strata_of(float ledge) {
  StrataControls controls;
  controls.ledge = ledge;
  controls.seed = 4;
  return Strata(controls);
}

TEST(Strata, MeansHardnessOverTheRockAroundADepth) {
  const Strata strata = strata_of(1.6f);
  for (const float reach_m : {45.0f, 16.0f}) {
    Row row(3600, 3.0f, 100, 21.3f);
    const auto mean = reach_m > 16.0f ? &Strata::hardness_row : &Strata::bed_hardness_row;
    (strata.*mean)(row.place(), row.height.data(), row.hardness.data());
    for (std::size_t i = 0; i < kWidth; ++i) {
      const float depth = row.stack[i] - row.height[i];
      double sum = 0;
      int samples = 0;
      for (float d = depth - reach_m; d < depth + reach_m; d += 0.05f, ++samples) {
        sum += static_cast<double>(strata.set(3).layer(strata.set(3).index_at(d)).hardness);
      }
      EXPECT_NEAR(static_cast<double>(row.hardness[i]), sum / samples, 0.03) << depth;
    }
  }
}

TEST(Strata, KeepsHeightsOfAColumnInOrderAtItsStrongest) {
  const Strata strata = strata_of(1.8f);
  for (const float choice : {0.0f, 2.5f, 7.43f, 11.0f}) {
    Row row(3600, choice, 80, 0.7f);
    std::ranges::fill(row.fashion, choice / 11.0f);
    const std::vector<float> before = row.height;
    row.ledge(strata);
    bool moved = false;
    for (std::size_t i = 1; i < kWidth; ++i) {
      ASSERT_GT(row.height[i], row.height[i - 1]) << choice;
      moved = moved || std::abs(row.height[i] - before[i]) > 0.5f;
    }
    EXPECT_TRUE(moved) << "no ledge at all";
  }
}

TEST(Strata, MakesHardBedsSteeperThanSoftOnes) {
  const Strata strata = strata_of(1.6f);
  double hard = 0;
  double soft = 0;
  int hards = 0;
  int softs = 0;
  for (int part = 0; part < 40; ++part) {
    Row row(3600, 5.0f, 80 + 47 * static_cast<float>(part), 0.5f);
    const std::vector<float> before = row.height;
    row.ledge(strata);
    for (std::size_t i = 0; i < kWidth; ++i) {
      const float hardness = strata.set(5).layer(strata.set(5).index_at(3600 - before[i])).hardness;
      (hardness > 0.6f ? hard : soft) += static_cast<double>(row.slope_x[i]);
      ++(hardness > 0.6f ? hards : softs);
    }
  }
  ASSERT_GT(hards, 100);
  ASSERT_GT(softs, 100);
  EXPECT_GT(hard / hards, 1.15);
  EXPECT_LT(soft / softs, 0.9);
}

TEST(Strata, LetsFormationsTakeTurnsInMakingLedges) {
  const Strata strata = strata_of(1.6f);
  int first = 0;
  int second = 0;
  for (int part = 0; part < 40; ++part) {
    const auto ledged = [&](float fashion) {
      Row row(3600, 5.0f, 80 + 47 * static_cast<float>(part), 0.5f);
      std::ranges::fill(row.fashion, fashion);
      row.ledge(strata);
      return row.slope_x;
    };
    const std::vector<float> a = ledged(0);
    const std::vector<float> b = ledged(1);
    for (std::size_t i = 0; i < kWidth; ++i) {
      const float bold_a = std::abs(a[i] - 1.0f);
      const float bold_b = std::abs(b[i] - 1.0f);
      first += bold_a > 2 * bold_b + 0.1f ? 1 : 0;
      second += bold_b > 2 * bold_a + 0.1f ? 1 : 0;
      ASSERT_GT(std::min(a[i], b[i]), 0.0f);
    }
  }
  EXPECT_GT(first, 200) << "of 3840: ledges of the first fashion alone";
  EXPECT_GT(second, 200) << "of 3840: ledges of the second alone";
}

TEST(Strata, FindsTheBasesOfHardBedsOverSoftOnes) {
  const Strata strata = strata_of(1.6f);
  const HardnessProfile profile(strata);
  test::Random random(31);
  int found = 0;
  for (int n = 0; n < 2'000; ++n) {
    const int set = static_cast<int>(random.whole(0, strata.sets() - 1));
    const auto height_m = static_cast<float>(random.real(0, 900));
    const auto ceiling_m = profile.ceiling_near(3'600, static_cast<float>(set), height_m);
    if (!ceiling_m) continue;
    ++found;
    ASSERT_LE(std::abs(*ceiling_m - height_m), 16.5f);
    const auto hardness = [&](float from_m, float to_m) {
      double sum = 0;
      int samples = 0;
      for (float y = from_m; y < to_m; y += 0.1f, ++samples)
        sum += static_cast<double>(strata.set(set).layer(strata.set(set).index_at(3'600 - y)).hardness);
      return sum / samples;
    };
    ASSERT_GT(hardness(*ceiling_m, *ceiling_m + 3), hardness(*ceiling_m - 2.5f, *ceiling_m) + 0.1);
  }
  EXPECT_GT(found, 400) << "of 2000";
  EXPECT_LT(found, 1'900) << "of 2000: rock of one kind has none";
  EXPECT_FALSE(profile.ceiling_near(3'600, 0, 3'599)) << "above the stack";
  EXPECT_FALSE(profile.ceiling_near(3'600, 0, -1'520)) << "below it";
}

TEST(Strata, KeepsTheRockOfALayerInPatches) {
  const Strata strata = strata_of(1.6f);
  test::Random random(12);
  int near_changes = 0;
  int far_changes = 0;
  for (int n = 0; n < 4'000; ++n) {
    const int index = static_cast<int>(random.whole(100, kLayers - 100));
    const float height = 3'600 - 0.5f * (strata.set(2).top_m(index) + strata.set(2).top_m(index + 1));
    const glm::dvec2 place{random.real(-1e9, 1e9), random.real(-1e9, 1e9)};
    const auto rock = [&](const glm::dvec2& at) { return strata.rock_at({3'600, 2.0f, height, at}); };
    near_changes += rock(place) != rock(place + glm::dvec2(3, 0)) ? 1 : 0;
    far_changes += rock(place) != rock(place + glm::dvec2(5'000, 0)) ? 1 : 0;
  }
  EXPECT_GT(far_changes, 1'000) << "of 4000: rocks change from place to place";
  EXPECT_LT(near_changes, 120) << "of 4000: but not from step to step";
  EXPECT_GT(near_changes, 4);
}

TEST(Strata, ShowsAWideCellTheRockThatMostOfItIsMadeOf) {
  const Strata strata = strata_of(1.6f);
  const LayerSet& set = strata.set(4);
  test::Random random(21);
  for (int n = 0; n < 300; ++n) {
    const double span = static_cast<double>(16 << (n % 6));
    const double depth = std::floor(random.real(300, 4'800));
    // Metres of every rock within half a span, layer by layer.
    std::array<double, kMaterials.size()> metres{};
    for (int index = 0; index < kLayers; ++index) {
      const double inside = std::min(depth + span / 2, static_cast<double>(set.top_m(index + 1))) -
                            std::max(depth - span / 2, static_cast<double>(set.top_m(index)));
      double below = 0;
      for (std::size_t k = 0; k < kRocksPerLayer; ++k) {
        const auto share = static_cast<double>(set.layer(index).cumulative[k]);
        metres[static_cast<std::size_t>(set.layer(index).rocks[k])] += std::max(inside, 0.0) * (share - below);
        below = share;
      }
    }
    const Material rock =
        strata.rock_at({5'000, 4.0f, static_cast<float>(5'000 - depth - 0.5), {random.real(-1e6, 1e6), 0}, span});
    EXPECT_NEAR(metres[static_cast<std::size_t>(rock)], std::ranges::max(metres), 0.01) << depth << " over " << span;
  }
}

TEST(Strata, GivesTheSameBitsOnEveryTarget) {
  const Strata strata = strata_of(1.6f);
  const auto run = [&] {
    Row row(3'555.5f, 6.47f, -300, 27.7f);
    strata.hardness_row(row.place(), row.height.data(), row.hardness.data());
    row.ledge(strata);
    return row;
  };
  const Row best = run();
  const int targets = test::for_each_simd_target([&](const char* target) {
    const Row row = run();
    EXPECT_EQ(row.height, best.height) << target;
    EXPECT_EQ(row.hardness, best.hardness) << target;
    EXPECT_EQ(row.slope_x, best.slope_x) << target;
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

}  // namespace
}  // namespace talus
