// The ground one walks on: what lies below fifteen metres. Pure.
//
// The last stage of the world function before its heights are bounded. What the ground is decides what is on it:
// meadows roll softly, walls of rock are cut by joints, scree lies at one angle and carries boulders, so do stream beds
// and the feet of sea cliffs, and beaches are smooth. Each is faded in by slope, ridge map and the coast, never
// switched, and is the same at every LOD.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/grid/column_grid.hpp"
#include "core/noise/gradient_noise.hpp"

namespace talus {

/// The manifest's [micro] and [detail] sections say what each does.
struct DetailControls {
  FractalNoise rough{60, 4, 2, 0.5, 0, 1};
  double rough_plain_m = 0.4;
  double rough_hill_m = 2.4;
  double joint_m = 1.0;
  double boulder_m = 9;
  double boulder_share = 0.35;
  double rock_slope = 1.1;
  std::uint64_t seed = 0;
};

/// What the stage reads, one array per quantity over a grid of columns.
struct DetailInput {
  std::span<const float> hilliness;  ///< 0 (plain) .. 1 (range)
  std::span<const float> ridge;      ///< ridge map, -1 (crease) .. +1 (ridge)
  std::span<const float> cliff_m;    ///< height of the sea cliff that stands near
  std::span<const float> beach;      ///< 0..1
};

/// The surface, changed in place.
struct DetailSurface {
  std::span<float> height_m, slope_x, slope_z;
};

/// Arrays of sample_count(grid) floats that `add_detail` needs as workspace.
inline constexpr std::size_t kDetailArrays = 9;

/// Spans hold sample_count(grid) floats, `workspace` kDetailArrays times as many. Slopes leave out how the conditions
/// change from place to place.
void add_detail(const DetailControls& controls, const ColumnGrid& grid, const DetailInput& input,
                const DetailSurface& surface, std::span<float> workspace);

/// Heights change by at most this, in metres.
double detail_bound(const DetailControls& controls);

}  // namespace talus
