// An optional east-west period P: the places x and x + P are one place, bit for bit. Pure.
//
// Problem: what hashes cells must give the cell at x and the cell at x + P one hash, and no cell may be cut by the
// seam. Answer: reduce the voxel first (integers, exact), fit a whole number of cells into the period, and reduce the
// index of every cell before it is hashed:
//   x     = wrapped(x_voxel, grid.wrap_voxel) * voxel_m
//   edge  = fitted_cell_m(cell_m, wrap_m)                 (cell_m itself where the world does not wrap)
//   cell  = floor(x / edge), and its neighbours; hash of wrapped(cell, cells_around(cell_m, wrap_m))
// A period is a multiple of 131072 m, so cells whose edge is a power of two up to that fit as they are. z never wraps.
#pragma once

#include <cmath>
#include <cstdint>

namespace talus {

/// `index` reduced to 0 .. count - 1; unchanged where `count` is 0 (no period).
constexpr std::int64_t wrapped(std::int64_t index, std::int64_t count) {
  if (count == 0) return index;
  const std::int64_t rest = index % count;
  return rest < 0 ? rest + count : rest;
}

/// Cells of about `cell_m` metres that make up a period of `wrap_m` metres: at least 1; 0 where there is no period.
inline std::int64_t cells_around(double cell_m, double wrap_m) {
  if (wrap_m <= 0) return 0;
  const double cells = std::floor(wrap_m / cell_m + 0.5);
  return cells < 1 ? 1 : static_cast<std::int64_t>(cells);
}

/// The edge near `cell_m` of which a whole number makes up the period.
inline double fitted_cell_m(double cell_m, double wrap_m) {
  return wrap_m <= 0 ? cell_m : wrap_m / static_cast<double>(cells_around(cell_m, wrap_m));
}

}  // namespace talus
