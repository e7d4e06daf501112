#include "protocol/interest_area.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <unordered_set>

#include "core/grid/chunk_face.hpp"
#include "core/grid/octree_order.hpp"
#include "protocol/limits.hpp"

#include "tests/support/rounds.hpp"

namespace talus::protocol {
namespace {

/// The leaf that holds a point, from the header's text alone: the coarsest chunk there that is not split.
ChunkKey leaf_at(const glm::dvec3& point, const View& view, const WorldShape& shape) {
  const double edge0 = shape.cells * shape.voxel_m;
  for (int lod = kViewLodMax;; --lod) {
    const double edge = edge0 * std::pow(2.0, lod);
    const glm::dvec3 low =
        glm::dvec3{std::floor(point.x / edge), std::floor(point.y / edge), std::floor(point.z / edge)} * edge;
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double nearest = std::clamp(view.position[axis], low[axis], low[axis] + edge);
      sum += (nearest - view.position[axis]) * (nearest - view.position[axis]);
    }
    const double radius = std::max(view.near_m / std::pow(2.0, view.lod_bias), kNearEdgesMin * edge0);
    const bool split = lod > 0 && std::sqrt(sum) < radius * std::pow(2.0, lod - 1);
    if (split) continue;
    return {lod, static_cast<std::int32_t>(low.x / edge), static_cast<std::int32_t>(low.y / edge),
            static_cast<std::int32_t>(low.z / edge)};
  }
}

std::vector<ChunkKey> area(const View& view, const WorldShape& shape) {
  std::vector<ChunkKey> out;
  interest_area(view, shape, out);
  return out;
}

struct Case {
  View view;
  WorldShape shape;
};

/// Views of every kind: near and far from the origin, small and large, on the ground and high above it.
std::vector<Case> cases(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  std::vector<Case> out;
  for (std::size_t i = 0; i < count; ++i) {
    Case one;
    one.shape.cells = i % 3 == 0 ? 16 : 32;
    one.shape.voxel_m = std::exp2(static_cast<double>(static_cast<int>(i % 5)) - 2.0);
    one.shape.height_range_m = {between(-1500, 0), between(100, 4500)};
    const double away = i % 4 == 0 ? 1.0e9 : 20'000;
    one.view.position = {between(-away, away), between(-2000, 6000), between(-away, away)};
    one.view.near_m = between(50, 300);
    one.view.far_m = between(0, 14'000);
    one.view.lod_bias = i % 2 == 0 ? 0.0 : between(-1, 2);
    one.view = clamped(one.view, one.shape);
    out.push_back(one);
  }
  return out;
}

constexpr std::uint64_t kSeed = 20261122;

TEST(InterestArea, CoversEveryPlaceInReachByExactlyTheLeafOfTheDefinition) {
  std::mt19937_64 random(kSeed);
  for (const auto& [view, shape] : cases(40, kSeed)) {
    const std::vector<ChunkKey> leaves = area(view, shape);
    const std::unordered_set<ChunkKey, ChunkKeyHash> known(leaves.begin(), leaves.end());
    EXPECT_EQ(known.size(), leaves.size()) << "duplicates, seed " << kSeed;
    for (int i = 0; i < 2000; ++i) {
      glm::dvec3 offset;
      for (int axis = 0; axis < 3; ++axis) {
        offset[axis] = std::uniform_real_distribution(-1.0, 1.0)(random) * std::exp2(-static_cast<double>(i % 8));
      }
      const glm::dvec3 point = view.position + offset * view.far_m;
      const glm::dvec3 way = point - view.position;
      if (std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z) > view.far_m) continue;
      if (point.y < shape.height_range_m.x || point.y > shape.height_range_m.y) continue;
      ASSERT_TRUE(known.contains(leaf_at(point, view, shape))) << "seed " << kSeed;
    }
  }
}

TEST(InterestArea, HoldsNothingButLeavesInReach) {
  for (const auto& [view, shape] : cases(40, kSeed + 1)) {
    for (const ChunkKey& key : area(view, shape)) {
      ASSERT_TRUE(is_valid(key));
      const BoxWorld box = box_of(key, shape.cells, shape.voxel_m);
      EXPECT_EQ(leaf_at(0.5 * (box.low + box.high), view, shape), key);
      const glm::dvec3 gap = view.position - glm::dvec3{std::clamp(view.position.x, box.low.x, box.high.x),
                                                        std::clamp(view.position.y, box.low.y, box.high.y),
                                                        std::clamp(view.position.z, box.low.z, box.high.z)};
      EXPECT_LE(std::sqrt(gap.x * gap.x + gap.y * gap.y + gap.z * gap.z), view.far_m * (1 + 1e-12));
      EXPECT_LE(box.low.y, shape.height_range_m.y);
      EXPECT_GT(box.high.y, shape.height_range_m.x);
    }
  }
}

TEST(InterestArea, HasNeighboursThatDifferByAtMostOneLod) {
  for (const auto& [view, shape] : cases(test::rounds(24), kSeed + 2)) {
    const std::vector<ChunkKey> leaves = area(view, shape);
    const std::unordered_set<ChunkKey, ChunkKeyHash> known(leaves.begin(), leaves.end());
    // A leaf may not touch (by face, edge or corner) a leaf two LODs coarser: such a one would hold a neighbour's
    // grandparent or a chunk above it.
    for (const ChunkKey& key : leaves) {
      for (int n = 0; n < 27; ++n) {
        ChunkKey at{key.lod, key.x + n % 3 - 1, key.y + n / 3 % 3 - 1, key.z + n / 9 - 1};
        if (at.lod + 2 > kViewLodMax) break;
        at = parent_of(at);
        while (at.lod < kViewLodMax) {
          at = parent_of(at);
          ASSERT_FALSE(known.contains(at)) << "LOD " << key.lod << " beside LOD " << at.lod;
        }
      }
    }
  }
}

TEST(InterestArea, KnowsItsLeavesWithoutWalkingAndGivesThemInTheOrderOfTheOctree) {
  for (const auto& [view, shape] : cases(24, kSeed + 3)) {
    const std::vector<ChunkKey> leaves = area(view, shape);
    const std::unordered_set<ChunkKey, ChunkKeyHash> known(leaves.begin(), leaves.end());
    EXPECT_TRUE(std::ranges::is_sorted(leaves, is_before_in_octree));
    const InterestArea tested(view, shape);
    for (const ChunkKey& key : leaves) {
      ASSERT_TRUE(tested.has_leaf(key));
      ChunkKey above = key;
      while (above.lod < kViewLodMax) {
        above = parent_of(above);
        ASSERT_FALSE(tested.has_leaf(above));
      }
      if (key.lod > 0) {
        for (const ChunkKey& child : children_of(key)) ASSERT_FALSE(tested.has_leaf(child));
      }
      for (const ChunkFace face : kAllChunkFaces) {
        const ChunkKey beside = neighbour_of(key, face);
        ASSERT_EQ(tested.has_leaf(beside), known.contains(beside));
        const ChunkKey coarser = parent_of(beside);
        ASSERT_EQ(tested.has_leaf(coarser), known.contains(coarser));
      }
    }
  }
}

TEST(InterestArea, PutsTheViewerIntoTheFinestLod) {
  View view;
  view.position = {100, 50, 100};
  const WorldShape shape;
  const std::vector<ChunkKey> leaves = area(clamped(view, shape), shape);
  EXPECT_NE(std::ranges::find(leaves, ChunkKey{0, 3, 1, 3}), leaves.end());
}

TEST(InterestArea, IsEmptyHighAboveTheWorld) {
  View view;
  view.position = {0, 1.0e6, 0};
  EXPECT_TRUE(area(clamped(view, {}), {}).empty());
}

TEST(InterestArea, StaysInsideTheWorldAtItsCorner) {
  const WorldShape shape;
  View view;
  view.position = {std::numeric_limits<double>::infinity(), 0, -std::numeric_limits<double>::infinity()};
  const View at_corner = clamped(view, shape);
  EXPECT_EQ(at_corner.position.x, kChunkLimit * 32.0);
  const std::vector<ChunkKey> leaves = area(at_corner, shape);
  EXPECT_FALSE(leaves.empty());
  for (const ChunkKey& key : leaves) ASSERT_TRUE(is_valid(key));
}

TEST(ClampedView, IsFiniteAndWithinLimitsWhateverCame) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> odd{nan, inf,    -inf,  0.0, -0.0, 1e300, -1e300, 5e-324, std::ldexp(1.0, 53),
                                1.0, -1.0e9, 128.0, 0.25};
  std::mt19937_64 random(kSeed);
  const auto pick = [&] { return odd[random() % odd.size()]; };
  const WorldShape shape;
  for (int round = 0; round < test::rounds(20'000); ++round) {
    const View view{
        {pick(), pick(), pick()}, {pick(), pick(), pick()}, {pick(), pick(), pick()}, pick(), pick(), pick()};
    const View out = clamped(view, shape);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LE(std::abs(out.position[axis]), kChunkLimit * 32.0);
      ASSERT_LE(std::abs(out.velocity[axis]), 1000.0);
    }
    const glm::dvec3& d = out.direction;
    ASSERT_NEAR(d.x * d.x + d.y * d.y + d.z * d.z, 1.0, 1e-12);
    ASSERT_TRUE(out.far_m >= 0 && out.far_m <= kFarMax);
    ASSERT_LE(std::abs(out.lod_bias), kLodBiasMax);
    const double edges = out.near_m * std::exp2(-out.lod_bias) / 32.0;
    ASSERT_GE(edges, kNearEdgesMin * (1 - 1e-12));
    ASSERT_LE(edges, kNearEdgesMax * (1 + 1e-12));
    const View again = clamped(out, shape);
    ASSERT_EQ(again.near_m, out.near_m);
    ASSERT_EQ(again.position, out.position);
  }
}

TEST(ClampedView, LeavesAReasonableViewAlone) {
  View view;
  view.position = {-1.5, 300, 1.0e9};
  view.velocity = {10, 0, -3};
  view.near_m = 200;
  view.far_m = 5000;
  view.lod_bias = 0.25;
  const View out = clamped(view, {});
  EXPECT_EQ(out.position, view.position);
  EXPECT_EQ(out.velocity, view.velocity);
  EXPECT_EQ(out.near_m, 200);
  EXPECT_EQ(out.far_m, 5000);
  EXPECT_EQ(out.lod_bias, 0.25);
}

TEST(ChunkUrgency, PrefersTheNearTheFineAheadAndTheWayOneMoves) {
  const WorldShape shape;
  View view = clamped({}, shape);
  const auto urgency = [&](ChunkKey key) { return chunk_urgency(view, shape, key); };
  EXPECT_LT(urgency({0, 0, 0, -1}), urgency({0, 0, 0, -4}));
  EXPECT_LT(urgency({0, 0, 0, -4}), urgency({0, 0, 0, 3})) << "ahead is -z";
  const double still = urgency({0, 10, 0, 0});
  view.velocity = {200, 0, 0};
  EXPECT_LT(urgency({0, 10, 0, 0}), still);
}

TEST(ChunkUrgency, IsFiniteAtEveryLeafOfOddViews) {
  for (const auto& [view, shape] : cases(12, kSeed + 3)) {
    for (const ChunkKey& key : area(view, shape)) {
      const double urgency = chunk_urgency(view, shape, key);
      ASSERT_TRUE(std::isfinite(urgency) && urgency >= 0);
    }
  }
}

}  // namespace
}  // namespace talus::protocol
