// The line between two plates, as a displacement of the straight one. Pure; private to core/plates.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/plates/plate.hpp"

namespace talus {

/// Samples a curve of this length and foot needs, a power of two: 0..1 is cut into this many steps.
int curve_samples(double length_m);

/// Floats of a curve's samples, in whole vectors.
constexpr std::size_t curve_floats(int samples) {
  return (static_cast<std::size_t>(kCurveBefore + samples + 1 + kCurveAfter) + 15) / 16 * 16;
}

struct CurveTerms {
  int samples = 0;
  float length_m = 0, foot_t = 0, half_m = 0;
  float wiggle = 0, wiggle_m = 0;
  std::uint64_t seed = 0;  ///< the fault's own, the same from both sides
};

/// Fills curve_floats samples, from -kCurveBefore on, of the whole displacement and of its first octave.
///
/// Noise on a circle, one turn for the whole fault, minus its value where the circle is cut: exactly 0 at both
/// vertices, where it also leaves along the straight line. Bent softly into kKiteShare of the kite's width.
void fault_curve(const CurveTerms& terms, float* full, float* broad);

/// The displacement at `t`, clamped to 0..1.
float curve_at(const float* curve, int samples, float t);

}  // namespace talus
