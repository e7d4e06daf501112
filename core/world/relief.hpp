// Hills on top of the macro field, what erosion is to do with them, and what lies under them. Private to core/world;
// pure.
#pragma once

#include <cstddef>
#include <span>

#include "core/world/terms.hpp"

namespace talus {

/// Height of the top of every stack before it is bent, in metres: above any summit.
inline constexpr float kStackTop = 3600.0f;

/// A noise over a grid of columns: value and slope.
struct NoiseArrays {
  float* v;
  float* x;
  float* z;
};

/// One row of the macro field and of the hills' noise, and what they make.
struct ReliefRow {
  const float *hilliness, *hilliness_x, *hilliness_z;  ///< 0..1 and its slopes per metre
  const float *floor, *lift;                           ///< height of the valleys, and from there to the peaks
  NoiseArrays hills;
  float *height, *slope_x, *slope_z;  ///< in: the macro field; out: with hills
  float *fade, *strength;             ///< out
};

/// Adds hills as high as hilliness says, and finds the fade target and the strength of erosion. `width` columns,
/// computed in whole vectors.
void relief_row(const ReliefTerms& terms, const ReliefRow& row, std::size_t width);

/// Where the rock layers lie: the height of their stack's top and which set of them rules.
struct StrataPlace {
  const float *fold, *fold_x, *tilt, *set_choice;  ///< noises, and a slope
  const float* hilliness;
  float *stack, *choice, *fashion;  ///< out
};
void strata_place_row(const WorldFunction::Terms& terms, const StrataPlace& row, std::size_t width);

/// strength *= 1 + (mean hardness - hardness) * 0.57 * resistance, so that hard rock is worn less as a whole.
void resist_row(float resistance, const float* hardness, float* strength, std::size_t width);

/// What fine gullies cut out of beds that withstand them is put back, and what they spare in soft ones is cut, up to as
/// much again: height and slope += kept * cut, where kept = 2.2 * resistance * (hardness - mean hardness), within +-1.
struct WithstandRow {
  const float* hardness;             ///< of the beds at the eroded height
  const float *cut, *cut_x, *cut_z;  ///< by fine gullies
  float *height, *slope_x, *slope_z;
};
void withstand_row(float resistance, const WithstandRow& row, std::size_t width);

/// height and slope += change, in place.
struct ChangeRow {
  const float *height_change, *x_change, *z_change;
  float *height, *slope_x, *slope_z;
};
void add_change_row(const ChangeRow& row, std::size_t width);

/// The clamp to the world's interval of heights, in place, and the steepness of the slope.
struct SurfaceLimits {
  float low_m, high_m;
};
struct SurfaceRow {
  const float *slope_x, *slope_z;
  float *height, *steepness;
};
void surface_row(const SurfaceLimits& limits, const SurfaceRow& row, std::size_t width);

}  // namespace talus
