#include "core/grid/axis.hpp"

#include <cmath>
#include <cstddef>

#include "core/base/hash.hpp"
#include "core/grid/wrap.hpp"

namespace talus {
namespace {

/// Repeats the last sample up to a whole vector, so that unused lanes compute on ordinary numbers.
void pad_rows(int count, int taps, Axis& out) {
  const auto used = static_cast<std::size_t>(count);
  const std::size_t end = (used + kRowPadding - 1) / kRowPadding * kRowPadding;
  for (std::size_t i = used; i < end; ++i) {
    out.fraction[i] = out.fraction[used - 1];
    for (int t = 0; t < taps; ++t) {
      auto& row = out.cell_hash[static_cast<std::size_t>(t)];
      row[i] = row[used - 1];
    }
  }
}

}  // namespace

Octave octave_on(const ColumnGrid& grid, double cells_per_m, std::uint64_t seed) {
  if (grid.wrap_voxel == 0) return {cells_per_m, seed};
  const std::int64_t cells = cells_around(1 / cells_per_m, period_m(grid));
  return {static_cast<double>(cells) / period_m(grid), seed, grid.wrap_voxel, cells};
}

void split_axis(const Octave& octave, int direction, std::int64_t start_voxel, std::int64_t step_voxel, double voxel_m,
                int count, int first_tap, int taps, Axis& out) {
  const std::uint64_t seed = mix64(octave.seed, static_cast<std::uint64_t>(direction));
  // Gradient noise is 0 on its lattice: a shift of its own keeps octaves from all being 0 at the origin.
  const double shift = static_cast<double>(seed >> 40) * 0x1p-14;
  const std::int64_t wrap_voxel = direction == 0 ? octave.wrap_voxel : 0;
  const std::int64_t cells = direction == 0 ? octave.cells_around : 0;
  bool known = false;
  std::int64_t last_cell = 0;
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    // The seam lies where a reduced position is 0; the cells to its left have the indices of those at its far end.
    const double position_m = static_cast<double>(wrapped(start_voxel + i * step_voxel, wrap_voxel)) * voxel_m;
    const double p = position_m * octave.cells_per_m + shift;
    const double floor = std::floor(p);
    out.fraction[at] = static_cast<float>(p - floor);
    const auto cell = static_cast<std::int64_t>(floor);
    for (int t = 0; t < taps; ++t) {
      auto& row = out.cell_hash[static_cast<std::size_t>(t)];
      row[at] = known && cell == last_cell
                    ? row[at - 1]
                    : static_cast<std::uint32_t>(
                          mix64(seed, static_cast<std::uint64_t>(wrapped(cell + first_tap + t, cells))));
    }
    known = true;
    last_cell = cell;
  }
  pad_rows(count, taps, out);
}

}  // namespace talus
