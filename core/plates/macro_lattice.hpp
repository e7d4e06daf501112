// The lattice on which the macro field is evaluated, and its interpolation. Pure; private to core/plates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/grid/column_grid.hpp"

namespace talus {

/// Value and slopes of one quantity at nodes.
struct NodeArrays {
  float* v;
  float* x;
  float* z;
};

/// How a grid's columns lie on the lattice along one axis.
struct NodeAxis {
  std::int64_t first_voxel = 0;
  std::int64_t step_voxel = 0;
  int nodes = 0;
  alignas(64) std::array<std::int32_t, kColumnsMax> left{};  ///< node at or before each column
  alignas(64) std::array<float, kColumnsMax> fraction{};     ///< of the way to the next node
};

/// The nodes that `count` columns need: those around them, or where every column is a node the columns themselves.
/// Requires lies_on_lattice.
NodeAxis node_axis(std::int64_t start_voxel, std::int64_t step_voxel, int count);
/// Whether columns are closer than nodes, or all on nodes. No other grid has few nodes for many columns.
bool lies_on_lattice(std::int64_t start_voxel, std::int64_t step_voxel);

/// One row of columns interpolated from the rows of nodes before and after it.
///
/// Bicubic Hermite: value and both slopes of the four nodes around, mixed derivatives 0. C1, and exactly a node's own
/// value and slopes at the node, so columns on nodes need no neighbours and coarse grids have the same bits as fine.
/// `before`, `after`: 3 arrays of node rows. `fraction_z`: of the way between them. `spacing_m`: between nodes.
/// out_x and out_z may be null.
void interpolate_row(const NodeAxis& x, const NodeArrays& before, const NodeArrays& after, float fraction_z,
                     float spacing_m, std::size_t width, float* out, float* out_x, float* out_z);

}  // namespace talus
