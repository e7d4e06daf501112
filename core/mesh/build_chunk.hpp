// From a key to a mesh: the whole path of a fresh chunk but its encoding. Pure; memory is the caller's.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/chunk_key.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "core/mesh/extract.hpp"
#include "core/world/density.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// Working memory of one thread. Once it has grown to its largest chunk no call allocates.
struct ChunkScratch {
  ColumnBlock columns;
  VolumeScratch volume;
  std::vector<HeightSpan> spans;      ///< of each row of columns: where its surface can be
  std::vector<LayerInterval> layers;  ///< of each row: those that the surface can touch, from the chunk's lowest
  std::vector<LayerInterval> wanted;  ///< the same, from the lowest of all rows
  std::vector<float> density;
  SignRows signs;
  CrossedEdges edges;
};

/// Fills `out` with the surface of `key` and returns kMesh, or leaves it empty and says what fills the chunk.
/// Requires is_valid(key).
ChunkKind build_chunk(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch, ChunkMesh& out);

/// The stages of build_chunk, for those who time or cache them one by one.
/// The columns a chunk stands on, with a halo of one column on every side for normals.
ColumnGrid chunk_columns(const WorldFunction& world, const ChunkKey& key);
/// What fills a chunk whose columns are rock below `low_m` and air from `high_m` on (metres), or kMesh where a surface
/// may cross it. A nanosecond; true for any such interval: the world's, or one remembered for the chunk's columns.
ChunkKind kind_by_heights(const WorldFunction& world, const ChunkKey& key, double low_m, double high_m);
/// Densities and signs of the part of the chunk that the surface can reach. Returns where the densities lie.
DensityBox sample_chunk(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch);
/// Vertices and triangles from sampled densities; kAir or kRock when no edge is crossed after all.
ChunkKind mesh_chunk(const WorldFunction& world, const ChunkKey& key, const DensityBox& box, ChunkScratch& scratch,
                     ChunkMesh& out);

}  // namespace talus
