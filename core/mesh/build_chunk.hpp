// From a key to a mesh: the whole path of a fresh chunk but its encoding. Pure; memory is the caller's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/grid/chunk_key.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// Working memory of one thread. After the first surface chunk no call allocates.
struct ChunkScratch {
  ColumnBlock columns;
  std::vector<float> density;        ///< (cells + 3)^3 samples
  std::vector<std::uint64_t> signs;  ///< one word per row of samples
  std::vector<std::uint32_t> first_vertex;
};

/// Fills `out` with the surface of `key` and returns kMesh, or leaves it empty and says what fills the chunk.
/// Requires is_valid(key).
ChunkKind build_chunk(const WorldFunction& world, const ChunkKey& key, ChunkScratch& scratch, ChunkMesh& out);

}  // namespace talus
