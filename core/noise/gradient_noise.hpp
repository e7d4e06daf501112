// Fractal gradient noise with its analytic gradient, over a grid of columns. Pure.
//
// Based on: K. Perlin, "Improving Noise", 2002 (quintic fade); I. Quilez, "Gradient noise derivatives", 2017. What
// differs: gradients are uniform in a square and hashed per lattice column and row, so a point costs one mixing of two
// words per corner.
#pragma once

#include <cstdint>
#include <span>

#include "core/grid/column_grid.hpp"

namespace talus {

inline constexpr int kNoiseOctavesMax = 8;

/// Octave o has wavelength wavelength_m / lacunarity^o and amplitude gain^o.
struct FractalNoise {
  double wavelength_m = 1000;
  int octaves = 1;  ///< 1..kNoiseOctavesMax
  double lacunarity = 2;
  double gain = 0.5;
  std::uint64_t seed = 0;
  double stretch_z = 1;  ///< wavelength along z over that along x
};

/// One octave has standard deviation 0.28 and stays within +-1.6; a sum is not normalised by its octaves.
/// 1.6 is the most four gradients of the unit square can give, 1, times this scale.
inline constexpr float kNoiseScale = 1.6f;
/// No value of `noise` lies outside +- this.
double noise_bound(const FractalNoise& noise);

/// value, d value / dx and d value / dz (per metre) at every column. Spans hold sample_count(grid) floats and do not
/// overlap.
void fractal_noise(const FractalNoise& noise, const ColumnGrid& grid, std::span<float> value, std::span<float> slope_x,
                   std::span<float> slope_z);

}  // namespace talus
