// How good the triangles are, whatever carries them: thin ones, cache misses, what simplifying would save.
#pragma once

#include "tests/bench/meshes/terrain_sample.hpp"

namespace talus::bench {

/// Prints the table of one sample.
void print_shapes(const TerrainSample& sample);

}  // namespace talus::bench
