#include "server/world/column_heights.hpp"

#include <algorithm>
#include <cmath>

#include "core/mesh/build_chunk.hpp"

namespace talus::server {

namespace {

/// What finer LODs may show beyond samples of a coarse one: ground between two samples is nearer than a cell to one of
/// them, and steeper than 2 over a whole cell only at cliffs, whose foot and brow are then both sampled.
constexpr double kMarginCells = 2.0;
/// Caves below and hard beds above, which coarse LODs do not have, and stacks thinner than a cell.
constexpr double kVolumeReachM = 48.0;

}  // namespace

std::vector<glm::dvec2> column_heights(const WorldFunction& world, const protocol::ColumnSquare& columns) {
  const double margin_m = kMarginCells * std::ldexp(world.voxel_m(), columns.lod) + kVolumeReachM;
  const glm::dvec2 range_m = world.height_range_m();
  ColumnBlock block;
  std::vector<glm::dvec2> out;
  out.reserve(static_cast<std::size_t>(columns.side * columns.side));
  for (int i = 0; i < columns.side * columns.side; ++i) {
    const ChunkKey key{columns.lod, columns.x + i % columns.side, 0, columns.z + i / columns.side};
    world.columns(chunk_columns(world, key), block);
    out.emplace_back(std::max(static_cast<double>(block.height_low_m) - margin_m, range_m.x),
                     std::min(static_cast<double>(block.height_high_m) + margin_m, range_m.y));
  }
  return out;
}

}  // namespace talus::server
