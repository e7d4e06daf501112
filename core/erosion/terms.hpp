// The filter's controls as its kernels want them. Private to core/erosion.
#pragma once

#include <array>
#include <cstddef>

#include "core/erosion/filter.hpp"
#include "core/grid/axis.hpp"

namespace talus {

/// Numbers of one octave, in the filter's units.
struct ErosionOctave {
  float strength_m;        ///< strength * scale * gain^o
  float side_slope_per_m;  ///< 2 pi * cell_scale * cells per metre: slope of a wave of 1 m at its steepest
  float rounding;          ///< rounding_octave^o
  float fine;              ///< share of its gullies that counts as fine, 0..1
};

/// Controls as floats, and the octaves; one per call of erode.
struct ErosionTerms {
  int octaves;
  std::array<ErosionOctave, kErosionOctavesMax> octave;
  float gully_weight, detail, rounding_ridge, rounding_crease, rounding_input, onset_input, onset_octave;
  float ridge_onset_input, ridge_onset_octave, assumed_slope, assumed_blend, cell_scale, shortest, offset;
  float frequency_slope, frequency_max, frequency_branch, frequency_pull, frequency_valley;
};

/// One row of columns: where it lies among each octave's cells, and its arrays.
struct ErosionRow {
  const std::array<Axis, kErosionOctavesMax>* x;
  const std::array<Axis, kErosionOctavesMax>* z;
  std::size_t k;  ///< row of the grid
  std::size_t width;
  const float *in_slope_x, *in_slope_z, *in_fade, *in_strength;
  const float* in_frequency;  ///< null where no point has a share of the frequency method
  float *height, *slope_x, *slope_z, *ridge;
  float *cut, *cut_x, *cut_z;  ///< null where nobody asks
};

}  // namespace talus
