// Keys of chunks that the surface is likely to cross.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/grid/chunk_key.hpp"
#include "core/world/world_function.hpp"
#include "tests/support/random.hpp"

namespace talus::test {

/// The chunk of `lod` that holds the surface at a random place, half of them within 40 chunks of the origin, half up to
/// 10^9 m.
inline ChunkKey random_surface_key(const WorldFunction& world, Random& random, int lod) {
  const std::int64_t edge = static_cast<std::int64_t>(world.cells()) << lod;
  const std::int64_t reach = (random.bits() & 1U) != 0 ? 40 : 1'000'000'000 / edge;
  const std::int64_t x = random.whole(-reach, reach);
  const std::int64_t z = random.whole(-reach, reach);
  ColumnBlock block;
  world.columns({x * edge + edge / 2, z * edge + edge / 2, 1, 1, 1, world.voxel_m()}, block);
  const double chunks = static_cast<double>(block.height_m[0]) / (static_cast<double>(edge) * world.voxel_m());
  return {lod, static_cast<std::int32_t>(x), static_cast<std::int32_t>(std::floor(chunks)),
          static_cast<std::int32_t>(z)};
}

}  // namespace talus::test
