// A rectangle of lattice columns: what a kernel is asked to fill. Pure data.
#pragma once

#include <cstddef>
#include <cstdint>

namespace talus {

/// Most columns along either side of a grid: a 32-cell chunk with its halo needs 35, a map tile 128 and a border.
inline constexpr int kColumnsMax = 160;
/// Rows are padded to whole vectors of the widest processor: 16 floats.
inline constexpr std::size_t kRowPadding = 16;

/// Column (i, k) stands at voxel (x_voxel + i * step_voxel, z_voxel + k * step_voxel).
struct ColumnGrid {
  std::int64_t x_voxel = 0;
  std::int64_t z_voxel = 0;
  std::int64_t step_voxel = 1;  ///< 2^lod
  int width = 0;                ///< columns along x, 1..kColumnsMax
  int depth = 0;                ///< columns along z, 1..kColumnsMax
  double voxel_m = 1.0;         ///< metres per voxel, a power of two: positions in metres are exact
  std::int64_t wrap_voxel = 0;  ///< east-west period of the world, 0 for none; the world function sets it

  friend bool operator==(const ColumnGrid&, const ColumnGrid&) = default;
};

/// East-west period in metres, 0 for none.
constexpr double period_m(const ColumnGrid& grid) {
  return static_cast<double>(grid.wrap_voxel) * grid.voxel_m;
}
/// Floats from one row of a grid's arrays to the next.
constexpr std::size_t row_stride(const ColumnGrid& grid) {
  return (static_cast<std::size_t>(grid.width) + kRowPadding - 1) / kRowPadding * kRowPadding;
}
/// Floats in one array over a grid.
constexpr std::size_t sample_count(const ColumnGrid& grid) {
  return row_stride(grid) * static_cast<std::size_t>(grid.depth);
}

}  // namespace talus
