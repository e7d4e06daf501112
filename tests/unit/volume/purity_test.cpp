// What the volume gives a lattice point is the same from every grid, LOD, memory and processor.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "tests/support/cliff_coast.hpp"
#include "tests/support/made_up_volume.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/simd_targets.hpp"

namespace talus {
namespace {

using test::CliffCoast;
using test::MadeUpVolume;

constexpr std::uint64_t kSeed = 3;
constexpr std::int64_t kLow_m = -32;
constexpr int kHigh_m = 96;

bool same_bits(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// A box of one LOD near the coast that is 64 m wide or 8 cells.
struct Box {
  ColumnGrid grid;
  std::int64_t y;
  int layers;
};

Box coast_box(test::Random& random, int lod, double voxel_m) {
  const std::int64_t step = std::int64_t{1} << lod;
  const auto voxels = [&](double metres) { return static_cast<std::int64_t>(metres / voxel_m) / step * step; };
  const int columns = lod < 3 ? 33 : 12;
  const std::int64_t x = voxels(random.real(-300, 300));
  const std::int64_t z = voxels(random.real(-110, 0));
  const std::int64_t y = voxels(static_cast<double>(kLow_m));
  const auto layers = static_cast<int>(static_cast<double>(kHigh_m - kLow_m) / voxel_m) / static_cast<int>(step) + 1;
  return {{x, z, step, columns, columns, voxel_m}, y, std::min(layers, 48)};
}

TEST(Volume, GivesALatticePointTheSameBitsFromEveryLodAndGrid) {
  for (const double voxel_m : {1.0, 0.5}) {
    CliffCoast coast(kSeed, voxel_m);
    const MadeUpVolume volume(coast);
    test::Random random(kSeed);
    MadeUpVolume::Memory used;
    int carved = 0;
    int jutting = 0;
    for (int round = 0; round < test::rounds(56); ++round) {
      const int lod = round % 7;
      const Box box = coast_box(random, lod, voxel_m);
      const auto coarse = volume.columns(box.grid, used);
      const auto values = volume.sample(coarse, box.y, box.layers, used);
      for (int n = 0; n < 6; ++n) {
        // The same column, alone in a grid of LOD 0 that knows nothing of what was built before.
        const auto i = random.whole(0, box.grid.width - 1);
        const auto k = random.whole(0, box.grid.depth - 1);
        MadeUpVolume::Memory fresh;
        const ColumnGrid one{box.grid.x_voxel + i * box.grid.step_voxel - n,
                             box.grid.z_voxel + k * box.grid.step_voxel - 1,
                             1,
                             8,
                             2,
                             voxel_m};
        const auto fine = volume.columns(one, fresh);
        for (int j = 0; j < box.layers; ++j) {
          const auto alone = volume.sample(fine, box.y + j * box.grid.step_voxel, 1, fresh);
          const float here = values[static_cast<std::size_t>((j * box.grid.depth + k) * box.grid.width + i)];
          ASSERT_TRUE(same_bits(here, alone[static_cast<std::size_t>(one.width + n)]))
              << "lod " << lod << ", voxel " << voxel_m << ", round " << round << ", layer " << j << ", seed " << kSeed;
        }
        carved += fine.spheres.empty() ? 0 : 1;
        jutting += fine.jut[static_cast<std::size_t>(row_stride(one)) + static_cast<std::size_t>(n)] > 0.0f ? 1 : 0;
      }
    }
    EXPECT_GT(carved, test::rounds(40)) << "too little of the coast was carved to compare";
    EXPECT_GT(jutting, test::rounds(40));
  }
}

TEST(Volume, IsNotThereOnCoarseLattices) {
  CliffCoast coast(kSeed);
  const MadeUpVolume volume(coast);
  MadeUpVolume::Memory memory;
  const auto still = volume.columns({-2048, -512, 32, 64, 32, 1.0}, memory);
  EXPECT_TRUE(still.spheres.empty());
  EXPECT_FALSE(still.has_jut);
  EXPECT_TRUE(memory.relief.fine.empty() || !memory.relief.fine[0].known) << "tiles were asked for in vain";
  const auto lod_4 = volume.columns({-512, -256, 16, 64, 32, 1.0}, memory);
  EXPECT_TRUE(lod_4.spheres.empty());
  EXPECT_FALSE(lod_4.has_jut);
}

TEST(Volume, LeavesNoPillarsBetweenTheSeaAndTheNextStillLevel) {
  CliffCoast coast(kSeed);
  const MadeUpVolume volume(coast);
  MadeUpVolume::Memory memory;
  int open = 0;
  int stumps = 0;
  for (std::int64_t x = -320; x <= 320; x += 16) {
    // The still column in the middle of 3 x 3 columns, from -4 m up to 14 m.
    for (std::int64_t z = -112; z <= 0; z += 16) {
      const auto columns = volume.columns({x - 1, z - 1, 1, 3, 3, 1.0}, memory);
      const auto values = volume.sample(columns, -4, 19, memory);
      const auto at = [&](int y_m, int i, int k) {
        return values[static_cast<std::size_t>(((y_m + 4) * 3 + k) * 3 + i)];
      };
      // Carved to its left and right at 6 m, under rock: no pillar stands between.
      if (columns.height[row_stride(columns.grid) + 1] < 14.0f || !(at(6, 0, 1) > 0.5f && at(6, 2, 1) > 0.5f)) continue;
      ++open;
      ASSERT_GT(at(6, 1, 1), 0.0f) << x << ", " << z;
      ASSERT_LT(at(0, 1, 1), 0.0f) << "the lattice point itself stays rock, " << x << ", " << z;
      ++stumps;
    }
  }
  EXPECT_GT(open, 3) << "no cave with a still column was found";
  EXPECT_EQ(open, stumps);
}

TEST(Volume, GivesTheSameBitsOnEveryTarget) {
  CliffCoast coast(kSeed);
  const MadeUpVolume volume(coast);
  const ColumnGrid grid{340, -66, 1, 45, 40, 1.0};
  const auto run = [&] {
    MadeUpVolume::Memory memory;
    const auto columns = volume.columns(grid, memory);
    EXPECT_TRUE(columns.has_jut);
    EXPECT_GT(columns.spheres.size(), 5U);
    return volume.sample(columns, -8, 40, memory);
  };
  const std::vector<float> best = run();
  const int targets = test::for_each_simd_target([&](const char* target) {
    const std::vector<float> values = run();
    EXPECT_EQ(std::memcmp(values.data(), best.data(), best.size() * sizeof(float)), 0) << target;
  });
  EXPECT_GE(targets, 2) << "nothing was compared";
}

TEST(Volume, DoesNotDependOnTheOrderInWhichTilesWereRemembered) {
  CliffCoast coast(kSeed);
  const MadeUpVolume volume(coast);
  const ColumnGrid grid{200, -80, 1, 33, 33, 1.0};
  MadeUpVolume::Memory fresh;
  const auto first = volume.sample(volume.columns(grid, fresh), -8, 30, fresh);
  MadeUpVolume::Memory used;
  // Another coast, and places whose tiles fall on the same slots.
  CliffCoast other(kSeed + 1);
  const MadeUpVolume elsewhere(other);
  elsewhere.columns(grid, used);
  for (const std::int64_t x : {1024, 2048, -1024, 0}) volume.columns({x + 200, -80, 1, 33, 33, 1.0}, used);
  EXPECT_EQ(first, volume.sample(volume.columns(grid, used), -8, 30, used));
}

}  // namespace
}  // namespace talus
