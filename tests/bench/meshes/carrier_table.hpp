// What may carry a mesh: bytes of each, and what encoding takes.
#pragma once

#include <string>

#include "tests/bench/meshes/terrain_sample.hpp"

namespace talus::bench {

/// Prints the table of one sample. With a folder, writes every payload there for decode.mjs, which times decoding.
void print_carriers(const TerrainSample& sample, const std::string& folder);

}  // namespace talus::bench
