// Ways to carry a mesh that the table compares.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tests/bench/meshes/terrain_sample.hpp"

namespace talus::bench {

struct Carrier {
  std::string name;
  /// How decode.mjs reads it: "draco", "mesh" (protocol's), "mesh+zstd" (the same, all behind the header in one zstd
  /// frame) or "" for what it does not.
  std::string decoder;
  std::function<std::vector<std::byte>(const SampleMesh&)> encode;
};

std::vector<Carrier> carriers();

}  // namespace talus::bench
