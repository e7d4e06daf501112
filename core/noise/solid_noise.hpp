// Gradient noise in space, row by row: what roughens the walls of caves. Pure.
//
// Based on: K. Perlin, "Improving Noise", 2002 (quintic fade). What differs: gradients are hashed, ten bits a
// component, from one word per axis, so that a row along x hashes its y and z once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/grid/axis.hpp"

namespace talus {

/// One octave along a row of samples: the axes as split_axis(octave, 0 | 1 | 2, ...) with two taps gives them.
struct SolidRow {
  const Axis* x;
  float fraction_y, fraction_z;
  std::array<std::uint32_t, 2> hash_y, hash_z;
};

/// Nothing of an octave of amplitude 1 lies outside +- this: eight gradients of the unit cube give 3/2 at most.
inline constexpr float kSolidNoiseBound = 1.5f;

/// value[i] += amplitude * noise for `width` samples, rounded up to whole vectors.
void add_solid_noise_row(const SolidRow& row, std::size_t width, float amplitude, float* value);

}  // namespace talus
