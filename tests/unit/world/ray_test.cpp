#include "core/world/ray.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <glm/geometric.hpp>

#include "tests/support/default_world.hpp"
#include "tests/support/rounds.hpp"

namespace talus {
namespace {

using test::world;

/// The density between LOD 0 samples at a place in metres, from a brick apart from the rays'.
double density_at(const glm::dvec3& p) {
  static DensityBrick brick;
  const glm::dvec3 low = glm::floor(p);
  brick.stand(world(), static_cast<std::int64_t>(low.x), static_cast<std::int64_t>(low.z), 1, 1);
  brick.sample(world(), static_cast<std::int64_t>(low.y), 2);
  return brick.density(p - low);
}

glm::dvec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const glm::dvec3 v{normal(random), normal(random) * 0.5 - 0.4, normal(random)};
  return glm::normalize(v);
}

TEST(Ray, HitsWhereTheDensityIsZeroAndPassesThroughAirBefore) {
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> place(-20'000, 20'000);
  DensityBrick brick;
  int hits = 0;
  for (int i = 0; i < test::rounds(30); ++i) {
    const glm::dvec3 from{place(random), 1800, place(random)};
    const glm::dvec3 direction = random_direction(random);
    const auto hit = cast_ray(world(), from, direction, 4000, brick);
    if (!hit) continue;
    ++hits;
    EXPECT_LT(glm::length(from + direction * hit->distance_m - hit->position_m), 1e-6);
    EXPECT_NEAR(density_at(hit->position_m), 0, 1e-4) << i;
    EXPECT_NEAR(glm::length(hit->normal), 1, 1e-9);
    // Every half metre on the last 80 m before the surface is air.
    for (double back = 0.01; back < std::min(80.0, hit->distance_m); back += 0.5) {
      ASSERT_GT(density_at(hit->position_m - direction * back), 0) << i << ": " << back << " m before the hit";
    }
  }
  EXPECT_GT(hits, test::rounds(10));
}

TEST(Ray, StraightDownMeetsTheHeightOfItsColumn) {
  ColumnBlock block;
  VolumeScratch volume;
  DensityBrick brick;
  for (const std::int64_t x : {0, 777, -12'345, 1'000'000'000}) {
    world().columns({x, -x, 1, 1, 1, 1.0}, block);
    world().volume(block, volume);
    ASSERT_TRUE(block.spheres.empty()) << "a place that is carved says nothing of its height";
    const auto hit =
        cast_ray(world(), {static_cast<double>(x), 2000, static_cast<double>(-x)}, {0, -1, 0}, 4000, brick);
    ASSERT_TRUE(hit) << x;
    EXPECT_GE(hit->position_m.y, static_cast<double>(block.height_m[0]) - 0.01) << x;
    EXPECT_LE(hit->position_m.y, static_cast<double>(top_m(block, 0)) + 0.01) << x;
    EXPECT_GT(hit->normal.y, 0);
  }
}

TEST(Ray, FromWithinRockHitsAtOnceAndUpwardsFromAirNever) {
  DensityBrick brick;
  const auto deep = cast_ray(world(), {10, -4000, 10}, {0, 1, 0}, 8000, brick);
  ASSERT_TRUE(deep);
  EXPECT_EQ(deep->distance_m, 0);
  const auto below = cast_ray(world(), {10, -250, 10}, glm::normalize(glm::dvec3(1, 0.1, 0)), 100, brick);
  ColumnBlock block;
  world().columns({10, 10, 1, 1, 1, 1.0}, block);
  if (block.height_m[0] > -249) {
    ASSERT_TRUE(below);
    EXPECT_EQ(below->distance_m, 0);
  }
  EXPECT_FALSE(cast_ray(world(), {10, 2500, 10}, {0, 1, 0}, 9000, brick));
  EXPECT_FALSE(cast_ray(world(), {10, 5000, 10}, glm::normalize(glm::dvec3(1, 0, 1)), 9000, brick));
  EXPECT_FALSE(cast_ray(world(), {10, 2500, 10}, {0, -1, 0}, 5, brick)) << "too short to reach the ground";
}

TEST(Ray, IsTheSameThereAndAtABillionMetresInItsOwnFrame) {
  DensityBrick brick;
  const auto hit = cast_ray(world(), {1e9 + 0.25, 1500, -1e9}, glm::normalize(glm::dvec3(0.5, -1, 0.25)), 5000, brick);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(density_at(hit->position_m), 0, 1e-3);
}

}  // namespace
}  // namespace talus
