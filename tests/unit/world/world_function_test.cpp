#include "core/world/world_function.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <thread>

#include "core/world/density.hpp"
#include "core/world/terms.hpp"
#include "tests/support/random.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kWorldSeed = 4711;

std::size_t index(const ColumnBlock& block, int i, int k) {
  return static_cast<std::size_t>(k) * block.stride + static_cast<std::size_t>(i);
}

bool same_column(const ColumnBlock& a, int ai, int ak, const ColumnBlock& b, int bi, int bk) {
  const auto same = [&](const std::vector<float>& x, const std::vector<float>& y) {
    return std::memcmp(&x[index(a, ai, ak)], &y[index(b, bi, bk)], sizeof(float)) == 0;
  };
  return same(a.height_m, b.height_m) && same(a.slope_x, b.slope_x) && same(a.slope_z, b.slope_z) &&
         same(a.steepness, b.steepness) && same(a.ridge, b.ridge) && same(a.hilliness, b.hilliness);
}

TEST(WorldFunction, GivesAColumnTheSameBitsInEveryGridAndAtEveryLod) {
  const WorldFunction world{Manifest()};
  test::Random random(kWorldSeed);
  ColumnBlock one;
  ColumnBlock many;
  for (int round = 0; round < 200; ++round) {
    const int lod = static_cast<int>(random.whole(0, 12));
    const std::int64_t step = std::int64_t{1} << lod;
    const std::int64_t reach = round % 2 == 0 ? 1'000 : 1'000'000'000 / step;
    const ColumnGrid grid{random.whole(-reach, reach) * step,    random.whole(-reach, reach) * step,   step,
                          static_cast<int>(random.whole(1, 40)), static_cast<int>(random.whole(1, 6)), 1.0};
    world.columns(grid, many);
    const int i = static_cast<int>(random.whole(0, grid.width - 1));
    const int k = static_cast<int>(random.whole(0, grid.depth - 1));
    world.columns({grid.x_voxel + i * step, grid.z_voxel + k * step, 1, 1, 1, 1.0}, one);
    ASSERT_TRUE(same_column(one, 0, 0, many, i, k)) << "seed " << kWorldSeed << ", round " << round;
  }
}

TEST(WorldFunction, GivesTheSameBitsOnEveryTarget) {
  const WorldFunction world{Manifest()};
  const ColumnGrid grid{999'999'000, -1'000'000'123, 2, 35, 35, 1.0};
  ColumnBlock best;
  world.columns(grid, best);
  const int targets = test::for_each_simd_target([&](const char* target) {
    ColumnBlock block;
    world.columns(grid, block);
    for (int k = 0; k < 35; ++k) {
      for (int i = 0; i < 35; ++i) ASSERT_TRUE(same_column(block, i, k, best, i, k)) << target;
    }
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

TEST(WorldFunction, IsSharedByThreadsWithoutAnyoneNoticing) {
  const WorldFunction world{Manifest()};
  const auto run = [&](std::int64_t x) {
    ColumnBlock block;
    world.columns({x, -x, 1, 48, 8, 1.0}, block);
    return block.height_m;
  };
  std::vector<std::vector<float>> alone;
  for (std::int64_t t = 0; t < 8; ++t) alone.push_back(run(t * 5'000));
  std::vector<std::vector<float>> together(8);
  std::vector<std::jthread> threads;
  for (std::int64_t t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] { together[static_cast<std::size_t>(t)] = run(t * 5'000); });
  }
  threads.clear();
  EXPECT_EQ(alone, together);
}

TEST(WorldFunction, HasTheSlopesOfItsReliefFromPlatesToHills) {
  Manifest manifest;
  for (const char* off :
       {"erosion.octaves", "strata.ledge", "micro.octaves", "coast.cliff_m", "coast.cliff_vary_m", "coast.fin_m",
        "coast.joint_m", "coast.beach", "cones.land_share", "cones.sea_share", "districts.badlands", "districts.dunes",
        "districts.mesas", "districts.karst", "districts.glacial", "detail.joint_m", "detail.boulder_share"})
    manifest.values[parameter_index(off)] = 0;
  manifest.values[parameter_index("coast.shelf")] = 1;
  const WorldFunction world{manifest};
  test::Random random(kWorldSeed);
  ColumnBlock block;
  int steep = 0;
  for (int round = 0; round < 300; ++round) {
    world.columns({random.whole(-500'000, 500'000), random.whole(-500'000, 500'000), 1, 9, 9, 1.0}, block);
    const auto height = [&](int i, int k) { return static_cast<double>(block.height_m[index(block, i, k)]); };
    const std::size_t middle = index(block, 4, 4);
    const double x = (height(8, 4) - height(0, 4)) / 8;
    const double z = (height(4, 8) - height(4, 0)) / 8;
    ASSERT_NEAR(x, static_cast<double>(block.slope_x[middle]), 0.01) << "seed " << kWorldSeed << ", round " << round;
    ASSERT_NEAR(z, static_cast<double>(block.slope_z[middle]), 0.01) << "seed " << kWorldSeed << ", round " << round;
    steep += std::hypot(x, z) > 0.1 ? 1 : 0;
  }
  EXPECT_GT(steep, 20) << "nothing had a slope";
}

TEST(WorldFunction, LetsHardBedsStandProudOfSoftOnesOnGulliedFlanks) {
  const auto heights = [](double resistance, ColumnBlock& out) {
    Manifest manifest;
    manifest.values[parameter_index("strata.resistance")] = resistance;
    const WorldFunction world(manifest);
    for (std::int64_t z = -60'000; z < -54'000; z += 2'000) {
      ColumnBlock block;
      world.columns({77'000, z, 16, 64, 64, 1.0}, block);
      for (int k = 0; k < 64; ++k) {
        for (int i = 0; i < 64; ++i) {
          out.height_m.push_back(block.height_m[index(block, i, k)]);
          out.stack_m.push_back(block.stack_m[index(block, i, k)]);
          out.choice.push_back(block.choice[index(block, i, k)]);
        }
      }
    }
  };
  ColumnBlock without;
  ColumnBlock with;
  heights(0, without);
  heights(1, with);
  const WorldFunction world{Manifest()};
  const Strata& strata = *world.terms().strata;
  double hard_m = 0;
  double soft_m = 0;
  int hards = 0;
  int softs = 0;
  for (std::size_t n = 0; n < with.height_m.size(); ++n) {
    std::array<float, 16> height{with.height_m[n]};
    std::array<float, 16> out{};
    std::array<float, 16> stack{with.stack_m[n]};
    std::array<float, 16> choice{with.choice[n]};
    strata.bed_hardness_row({stack.data(), choice.data(), nullptr, nullptr, 1}, height.data(), out.data());
    const float hardness = out[0];
    const double moved = static_cast<double>(with.height_m[n] - without.height_m[n]);
    if (hardness > 0.7f) {
      hard_m += moved;
      ++hards;
    } else if (hardness < 0.4f) {
      soft_m += moved;
      ++softs;
    }
  }
  ASSERT_GT(hards, 200);
  ASSERT_GT(softs, 200);
  std::printf("hard beds are moved by %.1f m, soft ones by %.1f m\n", hard_m / hards, soft_m / softs);
  EXPECT_GT(hard_m / hards, soft_m / softs + 3);
}

TEST(WorldFunction, HasNoStepsAndStaysWithinItsHeights) {
  const WorldFunction world{Manifest()};
  const glm::dvec2 range = world.height_range_m();
  test::Random random(kWorldSeed);
  ColumnBlock block;
  for (int round = 0; round < 60; ++round) {
    world.columns({random.whole(-2'000'000'000, 2'000'000'000), random.whole(-60'000, 60'000), 1, 128, 16, 0.25},
                  block);
    for (int k = 0; k < 16; ++k) {
      for (int i = 0; i < 128; ++i) {
        const double height = static_cast<double>(block.height_m[index(block, i, k)]);
        ASSERT_GE(height, range.x);
        ASSERT_LE(height, range.y);
        if (i > 0) {
          const double rise = std::abs(height - static_cast<double>(block.height_m[index(block, i - 1, k)]));
          ASSERT_LT(rise, 0.25 * 8.0) << "a wall steeper than 8 : 1, seed " << kWorldSeed << ", round " << round;
        }
      }
    }
  }
}

TEST(Density, IsNegativeInsideRockAndDependsOnItsPointAlone) {
  const WorldFunction world{Manifest()};
  ColumnBlock block;
  world.columns({1'000, 2'000, 4, 20, 20, 1.0}, block);
  const auto middle = static_cast<std::int64_t>(block.height_low_m) / 4 * 4;
  const int layers = 24;
  std::vector<float> samples(density_floats(block.grid, layers));
  VolumeScratch scratch;
  world.volume(block, scratch);
  const DensityBox box = sample_density(world, block, middle - 40, layers, {}, scratch, samples);
  for (int j = 0; j < layers; ++j) {
    for (int k = 0; k < 20; ++k) {
      for (int i = 0; i < 20; ++i) {
        const float value =
            samples[(static_cast<std::size_t>(j) * box.depth + static_cast<std::size_t>(k)) * box.stride +
                    static_cast<std::size_t>(i)];
        const float y = static_cast<float>(middle - 40 + 4 * j);
        const float height = block.height_m[index(block, i, k)];
        const float jut = block.has_jut ? block.jut_m[index(block, i, k)] : 0.0f;
        ASSERT_TRUE(y < height + jut || value >= 0.0f);
        ASSERT_TRUE(y >= height || !block.spheres.empty() || value < 0.0f);
      }
    }
  }
  std::vector<float> shifted(density_floats(block.grid, 3));
  const DensityBox part = sample_density(world, block, middle - 40 + 4 * 5, 3, {}, scratch, shifted);
  for (std::size_t n = 0; n < part.depth * part.stride - 16; ++n) {
    if (n % part.stride >= 20) continue;
    ASSERT_EQ(shifted[n], samples[5 * box.depth * box.stride + n]);
  }
}

TEST(Cover, PutsSandOnShoresSnowOnSummitsAndRockOnWalls) {
  const WorldFunction world{Manifest()};
  EXPECT_EQ(world.cover({1.0f, 1.0f, 0.0f, 0.1f, 1.0f, {0, 0}}), Material::kSand);
  EXPECT_EQ(world.cover({200.0f, 0.98f, 0.0f, 0.3f, 0.0f, {5, 9}}), Material::kGrass);
  EXPECT_EQ(world.cover({2'000.0f, 0.95f, 0.2f, 1.0f, 0.0f, {5, 9}}), Material::kSnow);
  EXPECT_EQ(world.cover({500.0f, 0.2f, 0.2f, 1.0f, 0.0f, {5, 9}}), Material::kRock);
}

}  // namespace
}  // namespace talus
