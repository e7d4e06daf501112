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

/// Where the rock layers lie: the height of their stack's top and which set of them rules.
struct StrataPlace {
  const float *fold, *tilt, *set_choice;  ///< noises
  float *stack, *choice;                  ///< out
};
void strata_place_row(const WorldFunction::Terms& terms, const StrataPlace& row, std::size_t width);

/// strength *= 1 + (mean hardness - hardness) * resistance, so that hard rock is worn less.
void resist_row(float resistance, const float* hardness, float* strength, std::size_t width);

/// height and slope += change, in place.
struct ChangeRow {
  const float *height_change, *x_change, *z_change;
  float *height, *slope_x, *slope_z;
};
void add_change_row(const ChangeRow& row, std::size_t width);

/// Roughness on top, the clamp to the world's interval of heights, and the slope's steepness; in place.
struct SurfaceRow {
  const float *hilliness, *micro, *micro_x, *micro_z;
  float *height, *slope_x, *slope_z, *steepness;
};
void surface_row(const WorldFunction::Terms& terms, const SurfaceRow& row, std::size_t width);

}  // namespace talus
