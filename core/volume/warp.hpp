// Strata warp: how far a column's surface stands out where its rock is hardest. Pure.
//
// Problem: evaluating the surface at p + d * w for each voxel (d up the slope, w from the hardness of the rock at that
// height) costs a surface per voxel, and its first order breaks up at the rims of cliffs. Answer: a fan of columns up
// the slope, read from fine tiles, as far as `reach` metres; at a voxel the surface is between the column's own and the
// highest of the fan by hardness. That is never below the first, so rock is only added, and what is added is joined to
// the slope it comes from at its own level. What floats is crumbs: rock that juts to the relief between nodes while the
// surface between them is lower.
#pragma once

#include "core/grid/column_grid.hpp"
#include "core/volume/controls.hpp"
#include "core/volume/relief_tiles.hpp"

namespace talus {

/// jut[i] = metres by which the surface rises where hardness is 1, in rows of row_stride(grid) floats; 0 where the land
/// is gentle. `patch` (working memory) and `jut` hold sample_count(grid) floats, `height` the exact surface. Returns
/// whether any is above 0.
bool warp_columns(const WarpControls& controls, Relief& relief, const ColumnGrid& grid, const float* height,
                  std::vector<float>& patch, float* jut);

/// Radius of the ball around a lattice point of kStill_m within which warp fades to nothing. Every ball is a pit in a
/// wall, in rows that catch the eye where they are wider than a voxel of LOD 0 or two.
inline constexpr float kWarpStillRadius_m = 1.1f;

}  // namespace talus
