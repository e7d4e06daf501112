// A world that wraps repeats its chunks after its period, bit for bit, and has no seam.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/mesh/build_chunk.hpp"
#include "tests/support/random.hpp"
#include "tests/support/surface_key.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kWrapSeed = 31;
constexpr std::int64_t kPeriod = 2 * 131'072;

Manifest wrapping() {
  Manifest manifest;
  manifest.values[parameter_index("world.wrap_m")] = static_cast<double>(kPeriod);
  return manifest;
}

TEST(Wrap, RepeatsWholeChunksBitForBitAtEveryLod) {
  const WorldFunction world{wrapping()};
  test::Random random(kWrapSeed);
  ChunkScratch scratch;
  ChunkMesh here;
  ChunkMesh there;
  int surfaces = 0;
  for (int n = 0; n < 120; ++n) {
    const int lod = n % (kLodMax + 1);
    ChunkKey key = test::random_surface_key(world, random, lod);
    const std::int64_t edge = static_cast<std::int64_t>(world.cells()) << lod;
    // A third of the keys lie right on the seam.
    if (n % 3 == 0) key.x = n % 2 == 0 ? 0 : -1;
    ChunkKey other = key;
    const auto turn = static_cast<std::int32_t>(kPeriod / edge);
    other.x += key.x > 0 ? -3 * turn : 2 * turn;
    const ChunkKind kind = build_chunk(world, key, scratch, here);
    ASSERT_EQ(build_chunk(world, other, scratch, there), kind);
    ASSERT_EQ(here.positions, there.positions) << "lod " << lod << ", seed " << kWrapSeed << ", round " << n;
    ASSERT_EQ(here.indices, there.indices);
    ASSERT_EQ(here.materials, there.materials) << "lod " << lod << ", seed " << kWrapSeed << ", round " << n;
    ASSERT_EQ(here.ridges, there.ridges);
    ASSERT_EQ(here.normals, there.normals);
    surfaces += kind == ChunkKind::kMesh ? 1 : 0;
  }
  EXPECT_GT(surfaces, 60);
}

TEST(Wrap, HasNoSeam) {
  const WorldFunction world{wrapping()};
  test::Random random(kWrapSeed);
  ColumnBlock block;
  for (int n = 0; n < 40; ++n) {
    world.columns({kPeriod * random.whole(-2, 2) - 16, random.whole(-1'000'000, 1'000'000), 1, 33, 33, 1}, block);
    for (std::size_t k = 0; k < 33; ++k) {
      double elsewhere = 0;
      const auto rise = [&](std::size_t i) {
        const float* row = &block.height_m[k * block.stride];
        return std::abs(static_cast<double>(row[i] - 2 * row[i + 1] + row[i + 2]));
      };
      for (std::size_t i = 0; i < 31; ++i) {
        if (i < 13 || i > 17) elsewhere = std::max(elsewhere, rise(i));
      }
      // Bends of a row at the seam, columns 15 to 17, are of the size of bends anywhere; a step of 2 m would not be.
      for (std::size_t i = 13; i <= 17; ++i) ASSERT_LT(rise(i), 3 * elsewhere + 0.5) << "seed " << kWrapSeed;
    }
  }
}

TEST(Wrap, RefusesAPeriodThatChunksDoNotFit) {
  Manifest manifest = wrapping();
  manifest.values[parameter_index("world.wrap_m")] = 131'073;
  EXPECT_EQ(manifest_faults(manifest).size(), 2U) << "neither chunks nor groups of plates fit";
  manifest.values[parameter_index("world.wrap_m")] = 131'072;
  EXPECT_TRUE(manifest_faults(manifest).empty());
  manifest.values[parameter_index("chunk.voxel_m")] = 2;
  EXPECT_EQ(manifest_faults(manifest).size(), 1U) << "a chunk of LOD 12 is 262144 m wide";
}

}  // namespace
}  // namespace talus
