// What a seam strip costs beside the chunk it belongs to.
#pragma once

#include "tests/bench/meshes/terrain_sample.hpp"

namespace talus::bench {

/// Time to make the strips of a view, with their columns evaluated for each and with columns that are known, beside the
/// time for their chunks; triangles and bytes. On standard output.
void print_strips(const WorldFunction& world, const TerrainSample& view);

}  // namespace talus::bench
