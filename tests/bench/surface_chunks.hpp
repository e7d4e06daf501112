// Chunks of mountain terrain to measure with: the same ones in every run.
#pragma once

#include <vector>

#include "core/grid/chunk_key.hpp"
#include "core/world/world_function.hpp"

namespace talus::bench {

/// `count` LOD `lod` chunks around the first range east of the origin whose columns cross the chunk's middle.
std::vector<ChunkKey> surface_chunks(const WorldFunction& world, int lod, int count);

}  // namespace talus::bench
