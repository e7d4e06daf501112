// Signed distance to the surface, in metres, negative inside rock: the only door from the world function to a mesh.
// Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/world/volume_scratch.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// A box of density samples over a grid of columns. Sample (i, j, k) is at (j * depth + k) * stride + i and stands at
/// voxel (grid.x_voxel + i * step, y_voxel + j * step, grid.z_voxel + k * step).
struct DensityBox {
  std::int64_t y_voxel = 0;
  int layers = 0;          ///< samples along y
  std::size_t stride = 0;  ///< floats from one row along x to the next
  std::size_t depth = 0;   ///< rows along z
};

/// Layers of a box: first .. first + count - 1.
struct LayerInterval {
  int first = 0;
  int count = 0;
};

/// Heights between which a surface can be, in metres: rock below, air from the upper one on.
struct HeightSpan {
  float low_m, high_m;
};

/// The span of each row of columns along z, carving and warp included. Requires a volume.
void row_spans(const WorldFunction& world, const ColumnBlock& columns, std::vector<HeightSpan>& out);

/// Samples of a row that are taken or left together: those of the longest vector.
inline constexpr int kPartSamples = 16;
constexpr int parts_of_row(const ColumnGrid& grid) {
  return (grid.width + kPartSamples - 1) / kPartSamples;
}
/// The span of each part of each row, and of the two columns on either side of it; part p of row k at
/// k * parts_of_row + p.
void part_spans(const WorldFunction& world, const ColumnBlock& columns, std::vector<HeightSpan>& out);

/// Floats that `sample_density` needs for a box of `layers` over `columns`: rows are written in whole vectors.
std::size_t density_floats(const ColumnGrid& grid, int layers);

/// Fills `samples` (density_floats of them) and says how they lie. The value at a lattice point depends on that point
/// alone. `wanted` names the layers of each row along z, or of each part of each row, that are needed, all others stay
/// as they are; empty: all.
/// Requires columns with a volume, on the lattice of their step, as `y_voxel` is.
DensityBox sample_density(const WorldFunction& world, const ColumnBlock& columns, std::int64_t y_voxel, int layers,
                          std::span<const LayerInterval> wanted, VolumeScratch& scratch, std::span<float> samples);

}  // namespace talus
