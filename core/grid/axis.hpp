// One axis of a lattice of columns, split into noise cells and fractions before any float arithmetic.
//
// Problem: a float holds a position of 10^9 m only to 64 m. Answer: the position is exact in a double, the cell is its
// floor (64-bit), and only the fraction becomes a float, so detail at 10^9 m is that at the origin. As a grid is
// separable, this and the hashing of cells cost once per row and column, not once per point. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "core/grid/column_grid.hpp"

namespace talus {

/// Cells next to a sample that a kernel looks at along one axis.
inline constexpr int kTapsMax = 4;

/// Where the samples of an axis lie among the cells of one octave.
struct Axis {
  alignas(64) std::array<float, kColumnsMax> fraction;                                 ///< in its cell, 0..1
  alignas(64) std::array<std::array<std::uint32_t, kColumnsMax>, kTapsMax> cell_hash;  ///< of cell + first_tap + t
};

/// What an octave is: cells per metre, and the seed that sets it apart from every other.
struct Octave {
  double cells_per_m = 0;
  std::uint64_t seed = 0;
  std::int64_t wrap_voxel = 0;    ///< east-west period, 0 for none
  std::int64_t cells_around = 0;  ///< cells that make it up
};

/// The octave that a grid's world has for about `cells_per_m`: where it wraps, a whole number of cells make up the
/// period, and cells_per_m, of both axes alike, is what that needs.
Octave octave_on(const ColumnGrid& grid, double cells_per_m, std::uint64_t seed);

/// Fills `count` samples (1..kColumnsMax) and the rest of their last vector from voxel `start` on, `step` voxels apart.
/// Taps are cells first_tap .. first_tap + taps - 1 relative to the sample's own. `direction` (0 for x, 1 for z) keeps
/// the axes' hashes apart.
void split_axis(const Octave& octave, int direction, std::int64_t start_voxel, std::int64_t step_voxel, double voxel_m,
                int count, int first_tap, int taps, Axis& out);

}  // namespace talus
