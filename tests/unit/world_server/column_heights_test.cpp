#include "server/world/column_heights.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/mesh/build_chunk.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rounds.hpp"

namespace talus::server {
namespace {

/// The lowest and highest vertex of all chunks of one column.
glm::dvec2 heights_of_meshes(const WorldFunction& world, ChunkKey key) {
  const double step_m = std::ldexp(world.voxel_m(), key.lod) / kStepsPerCell;
  const double edge_m = std::ldexp(world.cells() * world.voxel_m(), key.lod);
  ChunkScratch scratch;
  ChunkMesh mesh;
  glm::dvec2 out{1e300, -1e300};
  world.columns(chunk_columns(world, key), scratch.columns);
  world.volume(scratch.columns, scratch.volume);
  const auto first = static_cast<std::int32_t>(std::floor(static_cast<double>(scratch.columns.rock_below_m) / edge_m));
  const auto last = static_cast<std::int32_t>(std::floor(static_cast<double>(scratch.columns.air_above_m) / edge_m));
  for (key.y = first; key.y <= last; ++key.y) {
    if (build_chunk(world, key, scratch, mesh) != ChunkKind::kMesh) continue;
    for (const auto& p : mesh.positions) {
      const double y_m = key.y * edge_m + p.y * step_m;
      out = {std::min(out.x, y_m), std::max(out.y, y_m)};
    }
  }
  return out;
}

TEST(ColumnHeights, HoldTheMeshesOfTheColumnAtEveryLod) {
  const WorldFunction world{Manifest()};
  test::Random random(92);
  // Peaks, canyons, steep coasts, overhangs and a trench of the default world, and anywhere.
  std::vector<glm::dvec2> places{{117760, 71936},   {91648, 73472},  {76032, -59392}, {67584, -30208},
                                 {-69376, -112896}, {67499, -30379}, {-105472, 96512}};
  for (int i = 0; i < 8; ++i) places.emplace_back(random.real(-1e6, 1e6), random.real(-1e6, 1e6));
  places.resize(static_cast<std::size_t>(test::rounds(static_cast<int>(places.size()))));
  for (const glm::dvec2& place_m : places) {
    for (const int lod : {0, 3, 6, 9}) {
      const double edge_m = std::ldexp(world.cells() * world.voxel_m(), lod);
      const auto x = static_cast<std::int32_t>(std::floor(place_m.x / edge_m));
      const auto z = static_cast<std::int32_t>(std::floor(place_m.y / edge_m));
      const glm::dvec2 said = column_heights(world, {lod, x, z, 1}).front();
      EXPECT_TRUE(said.x >= world.height_range_m().x && said.y <= world.height_range_m().y);
      for (int finer = lod; finer >= 0; finer -= 2) {
        const int below = lod - finer;
        const double finer_m = std::ldexp(edge_m, -below);
        const ChunkKey key{finer, static_cast<std::int32_t>(std::floor(place_m.x / finer_m)), 0,
                           static_cast<std::int32_t>(std::floor(place_m.y / finer_m))};
        const double step_m = std::ldexp(world.voxel_m(), lod) / kStepsPerCell;
        const glm::dvec2 seen = heights_of_meshes(world, key);
        EXPECT_GE(seen.x, said.x - step_m)
            << "LOD " << finer << " in a column of LOD " << lod << " at " << place_m.x << ", " << place_m.y;
        EXPECT_LE(seen.y, said.y + step_m)
            << "LOD " << finer << " in a column of LOD " << lod << " at " << place_m.x << ", " << place_m.y;
      }
    }
  }
}

TEST(ColumnHeights, AreOfEveryColumnRowByRow) {
  const WorldFunction world{Manifest()};
  const auto square = column_heights(world, {5, -3, 7, 3});
  ASSERT_EQ(square.size(), 9U);
  EXPECT_EQ(square[5], column_heights(world, {5, -1, 8, 1}).front());
}

}  // namespace
}  // namespace talus::server
