// Height before erosion, and what erosion is to do with it. Private to core/world; pure.
//
// The door for plates: whatever decides continents and ranges fills these same arrays.
#pragma once

#include <cstddef>
#include <span>

#include "core/world/terms.hpp"

namespace talus {

/// A noise over a grid of columns: value and slope.
struct NoiseArrays {
  float* v;
  float* x;
  float* z;
};

/// One row's worth of what the relief is made of, and of what it makes.
struct ReliefRow {
  NoiseArrays continent, range, massif, crest, swell, relief;       ///< in
  float *height, *slope_x, *slope_z, *fade, *strength, *hilliness;  ///< out
};

/// Macro height (sea floor, shelf, plain, ranges), hills on top, fade target and erosion strength. `width` columns,
/// computed in whole vectors.
void relief_row(const MacroTerms& macro, const ReliefRow& row, std::size_t width);

/// What lies on the eroded relief: roughness, and the clamp to the world's interval of heights.
struct SurfaceRow {
  const float *height, *slope_x, *slope_z, *hilliness;  ///< relief
  const float *eroded, *eroded_x, *eroded_z;            ///< change by erosion
  const float *micro, *micro_x, *micro_z;               ///< roughness
  float *out_height, *out_slope_x, *out_slope_z, *out_steepness;
};
void surface_row(const WorldFunction::Terms& terms, const SurfaceRow& row, std::size_t width);

}  // namespace talus
