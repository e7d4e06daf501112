#include <gtest/gtest.h>

#include <cmath>

#include "core/mesh/density_tile.hpp"
#include "core/mesh/height_tile.hpp"
#include "tests/support/random.hpp"
#include "tests/support/surface_key.hpp"

namespace talus {
namespace {

using test::random_surface_key;

HeightTile height_of(const WorldFunction& world, const ChunkKey& key) {
  ColumnBlock columns;
  HeightTile tile;
  world.columns(chunk_columns(world, key), columns);
  sample_height_tile(world, columns, tile);
  return tile;
}

TEST(HeightTile, LiesWithinHalfAStepOfTheColumns) {
  const WorldFunction world{Manifest()};
  test::Random random(71);
  for (int round = 0; round < 20; ++round) {
    const ChunkKey key = random_surface_key(world, random, static_cast<int>(random.whole(0, kLodMax)));
    ColumnBlock columns;
    world.columns(chunk_columns(world, key), columns);
    const HeightTile tile = height_of(world, key);
    ASSERT_EQ(tile.heights.size(), 33U * 33U);
    for (std::size_t at = 0; at < tile.heights.size(); ++at) {
      const std::size_t column = (at / 33 + 1) * columns.stride + at % 33 + 1;
      EXPECT_LE(std::abs(tile.heights[at] * tile.step_m - static_cast<double>(columns.height_m[column])),
                tile.step_m / 2);
    }
  }
}

TEST(HeightTile, SharesItsBorderWithItsNeighbour) {
  const WorldFunction world{Manifest()};
  test::Random random(72);
  for (int round = 0; round < 10; ++round) {
    const ChunkKey key = random_surface_key(world, random, static_cast<int>(random.whole(0, kLodMax)));
    const HeightTile a = height_of(world, key);
    const HeightTile b = height_of(world, {key.lod, key.x + 1, key.y, key.z});
    for (std::size_t k = 0; k < 33; ++k) {
      EXPECT_EQ(a.heights[k * 33 + 32], b.heights[k * 33]);
      EXPECT_EQ(a.ridges[k * 33 + 32], b.ridges[k * 33]);
      EXPECT_EQ(a.materials[k * 33 + 32], b.materials[k * 33]);
    }
  }
}

/// Whether a tile's signs are those the mesh was extracted from, and its materials air just where there is none.
void expect_signs_of_mesh(const DensityTile& tile, const SignRows& signs) {
  for (std::size_t y = 0; y < 33; ++y) {
    for (std::size_t z = 0; z < 33; ++z) {
      for (std::size_t x = 0; x < 33; ++x) {
        const std::size_t at = (y * 33 + z) * 33 + x;
        const bool is_rock = (signs.rows[y * 33 + z] >> x & 1U) != 0;
        ASSERT_EQ(tile.densities[at] < 0, is_rock);
        ASSERT_EQ(tile.materials[at] != kNoMaterial, is_rock);
      }
    }
  }
}

TEST(DensityTile, HasTheSignsAndCrossingsOfTheMesh) {
  const WorldFunction world{Manifest()};
  test::Random random(73);
  int meshes = 0;
  for (int round = 0; round < 30; ++round) {
    const ChunkKey key = random_surface_key(world, random, static_cast<int>(random.whole(0, kLodMax)));
    ChunkScratch scratch;
    ChunkMesh mesh;
    DensityTile tile;
    const ChunkKind kind = build_chunk(world, key, scratch, mesh);
    if (kind != ChunkKind::kMesh) continue;
    ++meshes;
    const SignRows signs = scratch.signs;
    const CrossedEdges edges = scratch.edges;
    ASSERT_EQ(sample_density_tile(world, key, scratch, tile), ChunkKind::kMesh);
    expect_signs_of_mesh(tile, signs);
    std::size_t vertex = 0;
    for_each_crossed_edge(signs, edges, [&](const CrossedEdge& e) {
      const int at = (e.y * 33 + e.z) * 33 + e.x;
      const int to = at + (e.axis == 0 ? 1 : e.axis == 1 ? 33 * 33 : 33);
      const float from_density = static_cast<float>(tile.densities[static_cast<std::size_t>(at)]) + 0.5F;
      const float to_density = static_cast<float>(tile.densities[static_cast<std::size_t>(to)]) + 0.5F;
      const int step = mesh.positions[vertex++][e.axis] % kStepsPerCell;
      // Half a step of density at either end is at most this much of a crossing.
      const float slack = 1.0F + 1.5F * kStepsPerCell / std::max(std::abs(from_density - to_density), 1.0F);
      EXPECT_NEAR(crossing_step(from_density, to_density), step, slack);
    });
  }
  EXPECT_GT(meshes, 10);
}

TEST(DensityTile, SaysWhatFillsAChunkWithoutSurface) {
  const WorldFunction world{Manifest()};
  for (const auto& [y, kind] : {std::pair{3000, ChunkKind::kAir}, std::pair{-3000, ChunkKind::kRock}}) {
    const ChunkKey key{0, 5, y, 5};
    ChunkScratch scratch;
    DensityTile tile;
    world.columns(chunk_columns(world, key), scratch.columns);
    EXPECT_EQ(sample_density_tile(world, key, scratch, tile), kind);
  }
}

}  // namespace
}  // namespace talus
