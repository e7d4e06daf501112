#include "tests/bench/meshes/terrain_sample.hpp"

#include <cmath>
#include <numbers>
#include <set>
#include <unordered_map>
#include <utility>

#include "core/grid/chunk_face.hpp"
#include "core/mesh/build_chunk.hpp"
#include "core/mesh/seam_strip.hpp"
#include "protocol/interest_area.hpp"
#include "tests/bench/surface_chunks.hpp"

namespace talus::bench {
namespace {

SampleMesh chunk_sample(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch) {
  SampleMesh out{{}, protocol::mesh_lattice(key, world.cells(), world.voxel_m()), key.lod, false};
  build_chunk(world, key, scratch, out.mesh);
  return out;
}

}  // namespace

TerrainSample chunks_of_lod(const WorldFunction& world, int lod, int count) {
  TerrainSample out{"LOD " + std::to_string(lod), 0.0, {}, {}};
  ChunkScratch scratch;
  for (const ChunkKey& key : surface_chunks(world, lod, count)) {
    SampleMesh made = chunk_sample(world, key, scratch);
    if (!made.mesh.indices.empty()) out.meshes.push_back(std::move(made));
  }
  return out;
}

TerrainSample view_from(const WorldFunction& world, std::string name, double x_m, double z_m, double far_m) {
  TerrainSample out{std::move(name), std::numbers::pi * far_m * far_m * 1e-6, {}, {}};
  const protocol::WorldShape shape{world.cells(), world.voxel_m(), world.height_range_m()};
  ColumnBlock column;
  const auto voxel = [&](double m) { return static_cast<std::int64_t>(std::floor(m / world.voxel_m())); };
  world.columns({voxel(x_m), voxel(z_m), 1, 1, 1, world.voxel_m()}, column);
  protocol::View view;
  view.position = {x_m, static_cast<double>(column.height_m[0]) + 60.0, z_m};
  view.far_m = far_m;
  std::vector<ChunkKey> keys;
  protocol::interest_area(protocol::clamped(view, shape), shape, keys);

  ChunkScratch scratch;
  std::unordered_map<ChunkKey, unsigned, ChunkKeyHash> faces;
  for (const ChunkKey& key : keys) {
    SampleMesh made = chunk_sample(world, key, scratch);
    faces[key] = faces_reached(made.mesh, world.cells());
    if (!made.mesh.indices.empty()) out.meshes.push_back(std::move(made));
  }
  std::set<StripKey> strips;
  for (const auto& [key, reached] : faces) {
    for (const ChunkFace face : kAllChunkFaces) {
      const ChunkKey across = parent_of(neighbour_of(key, face));
      if ((reached & bit_of(face)) != 0 && faces.contains(across)) strips.insert({across, opposite(face)});
    }
  }
  StripScratch strip_scratch;
  const ColumnLoader columns = [&](const ChunkKey& key, ColumnBlock& block) {
    world.columns(chunk_columns(world, key), block);
  };
  for (const StripKey& strip : strips) {
    SampleMesh made{{}, protocol::strip_lattice(strip.key, world.cells(), world.voxel_m()), strip.key.lod, true};
    build_strip(world, strip.key, strip.face, columns, strip_scratch, made.mesh);
    if (made.mesh.indices.empty()) continue;
    out.meshes.push_back(std::move(made));
    out.strips.push_back(strip);
  }
  return out;
}

}  // namespace talus::bench
