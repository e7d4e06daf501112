// What warp and carving make of a coast of cliffs, counted in 1 m voxels.
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "tests/support/cliff_coast.hpp"
#include "tests/support/made_up_volume.hpp"

namespace talus {
namespace {

using cli::RockBlock;
using test::CliffCoast;
using test::MadeUpVolume;

constexpr std::int64_t kBottom_m = -14;
constexpr int kHeight_m = 110;
/// The slice of the search: 2 m above the sea.
constexpr int kSlice = 2 - static_cast<int>(kBottom_m);

RockBlock coast_block(const MadeUpVolume& volume, int width_m) {
  MadeUpVolume::Memory memory;
  return volume.block(-width_m / 2, kBottom_m, -192, width_m, kHeight_m, 256, memory);
}

TEST(Coast, HasArchesCavesAndDeepOverhangsAndNextToNothingFloats) {
  CliffCoast coast(3);
  const MadeUpVolume volume(coast);
  const RockBlock block = coast_block(volume, 1024);
  int arches = 0;
  int caves = 0;
  for (const cli::Cavity& cavity : find_cavities(block, kSlice)) {
    arches += cavity.is_arch() ? 1 : 0;
    caves += cavity.is_cave() ? 1 : 0;
  }
  const int shore_m = coast_cells(block, kSlice);
  const int overhang = count_overhangs(block, 2);
  const int deep = count_overhangs(block, 6);
  const auto detached = cli::find_detached(block);
  const int floating = std::accumulate(detached.begin(), detached.end(), 0);
  std::printf("%d m of shore: %d arches, %d caves, %d m2 under overhangs, %d m2 under deep ones, %zu pieces of %d m3\n",
              shore_m, arches, caves, overhang, deep, detached.size(), floating);
  EXPECT_GE(arches, 2);
  EXPECT_GE(caves, 6);
  EXPECT_GT(overhang, shore_m);
  EXPECT_GT(deep, shore_m / 2);
  EXPECT_LE(detached.empty() ? 0 : detached[0], 10) << "a piece of rock floats";
  EXPECT_LE(static_cast<double>(detached.size()), 5e-3 * shore_m + 1);
}

TEST(Warp, MakesOverhangsAndDetachesNothing) {
  CliffCoast coast(5);
  MadeUpVolume volume(coast);
  for (CarvePass& pass : volume.carve.passes) pass.probability = 0;
  const RockBlock block = coast_block(volume, 512);
  EXPECT_TRUE(cli::find_detached(block).empty());
  EXPECT_GT(count_overhangs(block, 2), coast_cells(block, kSlice) / 4);
  volume.warp.reach_m = 0;
  EXPECT_EQ(count_overhangs(coast_block(volume, 512), 2), 0) << "the surface itself hangs over";
}

TEST(Warp, OnlyAddsRockAndNoFurtherThanItsReach) {
  CliffCoast coast(5);
  MadeUpVolume volume(coast);
  MadeUpVolume::Memory memory;
  const auto columns = volume.columns({-100, -100, 1, 120, 120, 1.0}, memory);
  ASSERT_TRUE(columns.has_jut);
  for (int k = 8; k < 112; ++k) {
    for (int i = 8; i < 112; ++i) {
      const auto at = static_cast<std::size_t>(k) * row_stride(columns.grid) + static_cast<std::size_t>(i);
      ASSERT_GE(columns.jut[at], 0.0f);
      // Nodes of 4 m are read between: 4 m of reach and the cell around its end.
      float highest = -1e9f;
      for (int dk = -8; dk <= 8; ++dk)
        for (int di = -8; di <= 8; ++di)
          highest = std::max(
              highest,
              columns.height[at + static_cast<std::size_t>(di + dk * static_cast<int>(row_stride(columns.grid)))]);
      ASSERT_LE(columns.height[at] + columns.jut[at], highest + 0.5f);
    }
  }
}

TEST(Carving, WithoutAPassHasNoneOfItsSpheres) {
  CliffCoast coast(3);
  MadeUpVolume volume(coast);
  const ColumnGrid grid{-80, -140, 1, 160, 160, 1.0};
  for (std::size_t off = 0; off < kCarvePasses; ++off) {
    MadeUpVolume::Memory memory;
    const CarvePass kept = volume.carve.passes[off];
    volume.carve.passes[off].probability = 0;
    const auto columns = volume.columns(grid, memory);
    EXPECT_FALSE(columns.spheres.empty());
    for (const CarveSphere& s : columns.spheres) EXPECT_NE(static_cast<std::size_t>(s.kind), off);
    volume.carve.passes[off] = kept;
  }
}

/// All that is carved along the wall of a made-up coast, `tiles` to either side.
std::vector<CarveSphere> carved_along(const MadeUpVolume& volume, Relief& relief, std::int64_t tiles) {
  std::vector<CarveSphere> spheres;
  for (std::int64_t tile = -tiles; tile < tiles; ++tile) grow_tile(volume.carve, relief, tile, -1, spheres);
  return spheres;
}

float top_of(const CarveSphere& sphere) {
  return sphere.y_m + sphere.radius_m / sphere.inverse_stretch;
}

TEST(Carving, HangsAlcovesFromTheBaseOfHardBeds) {
  CliffCoast coast(3);
  const MadeUpVolume volume(coast);
  MadeUpVolume::Memory memory;
  Relief relief(coast, memory.relief);
  int whole = 0;
  for (const CarveSphere& s : carved_along(volume, relief, 24)) {
    if (s.kind != CarveKind::kAlcoves) continue;
    const float top_m = top_of(s);
    const float under_m = *coast.ceiling_near(0, 0, top_m - 0.5f) - top_m;
    EXPECT_GT(under_m, -0.5f) << "it breaks through the hard bed at " << top_m;
    // Where the roof rule left it its height it reaches the bed.
    const bool is_whole = std::abs(1.0f / s.inverse_stretch - volume.carve.pass(s.kind).stretch) < 0.01f;
    if (is_whole) {
      EXPECT_LT(under_m, 0.5f) << top_m;
    }
    whole += is_whole ? 1 : 0;
  }
  EXPECT_GT(whole, 20);
}

TEST(Carving, LeadsAlcovesDownFromTheirBedByTheirFall) {
  CliffCoast coast(3);
  MadeUpVolume level(coast);
  CarvePass& alcoves = level.carve.passes[static_cast<std::size_t>(CarveKind::kAlcoves)];
  alcoves.fall = 0;
  MadeUpVolume falling(coast);
  falling.carve = level.carve;
  falling.carve.passes[static_cast<std::size_t>(CarveKind::kAlcoves)].fall = 0.5f;
  MadeUpVolume::Memory memory;
  Relief relief(coast, memory.relief);
  const auto mean_height_m = [&](const MadeUpVolume& volume) {
    double sum_m = 0;
    int count = 0;
    for (const CarveSphere& s : carved_along(volume, relief, 24)) {
      if (s.kind != CarveKind::kAlcoves) continue;
      sum_m += static_cast<double>(s.y_m);
      ++count;
    }
    return sum_m / count;
  };
  EXPECT_LT(mean_height_m(falling), mean_height_m(level) - 0.3);
}

TEST(Carving, LeavesARoofOverEveryCave) {
  CliffCoast coast(3);
  const MadeUpVolume volume(coast);
  MadeUpVolume::Memory memory;
  Relief relief(coast, memory.relief);
  int looked_at = 0;
  for (const CarveSphere& s : carved_along(volume, relief, 8)) {
    if (s.kind == CarveKind::kArches) continue;
    // A mouth's roof is looked for 1.6 radii further in.
    const auto reach_m = static_cast<double>(1.6f * s.radius_m);
    float highest = relief.height_at(s.x_m, s.z_m);
    for (const double x : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0})
        highest = std::max(highest, relief.height_at(s.x_m + reach_m * x, s.z_m + reach_m * z));
    }
    EXPECT_LT(top_of(s), highest) << "nothing is above it within a mouth's reach";
    ++looked_at;
  }
  EXPECT_GT(looked_at, 100);
}

}  // namespace
}  // namespace talus
