#include "tests/bench/surface_chunks.hpp"

#include <cmath>

namespace talus::bench {

std::vector<ChunkKey> surface_chunks(const WorldFunction& world, int lod, int count) {
  std::vector<ChunkKey> keys;
  ColumnBlock block;
  const std::int64_t edge = static_cast<std::int64_t>(world.cells()) << lod;
  for (std::int32_t n = 0; keys.size() < static_cast<std::size_t>(count); ++n) {
    const std::int32_t x = n * 37 % 4001;
    const std::int32_t z = n * 91 % 4003;
    world.columns({x * edge + edge / 2, z * edge + edge / 2, 1, 1, 1, world.voxel_m()}, block);
    if (block.hilliness[0] < 0.8f || block.height_m[0] < 200.0f) continue;
    const double chunks = static_cast<double>(block.height_m[0]) / (static_cast<double>(edge) * world.voxel_m());
    keys.push_back({lod, x, static_cast<std::int32_t>(std::floor(chunks)), z});
  }
  return keys;
}

}  // namespace talus::bench
