#include "core/plates/fault_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/base/hash.hpp"

#ifndef TALUS_FAULT_CURVE_TERMS
#define TALUS_FAULT_CURVE_TERMS
namespace talus {

inline constexpr std::size_t kCurveOctaves = 4;
/// Frequency and amplitude from one octave to the next.
inline constexpr double kCurveLacunarity = 2.1;
inline constexpr double kCurveGain = 0.42;
/// A short fault still bends: its circle has at least this many cells around it.
inline constexpr double kCurveCellsMin = 1.6;
/// Share of a fault at either end over which it straightens towards its vertex.
inline constexpr float kCurveTaper = 0.12f;

/// One octave's circle.
struct CurveCircle {
  float radius, centre_x, centre_z, amplitude_m;
  std::uint32_t seed;
};

}  // namespace talus
#endif  // TALUS_FAULT_CURVE_TERMS

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plates/fault_curve.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"
#include "core/noise/lane_noise-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Displacement bent into `width` and straightened towards the vertices.
template <class D, class V = VecOf<D>>
HWY_INLINE V bent(D d, V displacement, V width, V taper) {
  const V square = hn::Add(hn::Add(hn::Mul(displacement, displacement), hn::Mul(width, width)), hn::Set(d, 1e-6f));
  return hn::Mul(hn::Div(hn::Mul(displacement, width), hn::Sqrt(square)), taper);
}

template <class D, class V = VecOf<D>>
HWY_INLINE V on_circle(D d, const CurveCircle& circle, V t) {
  V cosine;
  V sine;
  cos_sin_cycles(d, t, cosine, sine);
  const V radius = hn::Set(d, circle.radius);
  return lane_noise(d, hn::Add(hn::Set(d, circle.centre_x), hn::Mul(radius, cosine)),
                    hn::Add(hn::Set(d, circle.centre_z), hn::Mul(radius, sine)), circle.seed);
}

void fault_curve_target(const CurveTerms& terms, const CurveCircle* circles, float* full, float* broad) {
  const hn::CappedTag<float, 16> d;
  using V = hn::Vec<decltype(d)>;
  const V one = hn::Set(d, 1.0f);
  const float last = static_cast<float>(terms.samples);
  std::array<V, kCurveOctaves> cut;
  for (std::size_t o = 0; o < kCurveOctaves; ++o) cut[o] = on_circle(d, circles[o], hn::Zero(d));

  const auto floats = static_cast<int>(curve_floats(terms.samples));
  for (int i = 0; i < floats; i += static_cast<int>(hn::Lanes(d))) {
    // Samples before 0 and after 1 mirror those within, so that the cubic's slope at both vertices is 0.
    const V index = hn::Abs(hn::Iota(d, static_cast<float>(i - kCurveBefore)));
    const V mirrored = hn::Min(index, hn::Sub(hn::Set(d, 2 * last), index));
    const V t = saturate(hn::Mul(mirrored, hn::Set(d, 1.0f / last)));
    const V end = hn::Sub(one, t);
    V width = hn::Set(d, 1e30f);
    if (terms.foot_t > 0.0f) width = hn::Mul(t, hn::Set(d, terms.half_m / terms.foot_t));
    if (terms.foot_t < 1.0f) width = hn::Min(width, hn::Mul(end, hn::Set(d, terms.half_m / (1.0f - terms.foot_t))));
    width = hn::Mul(width, hn::Set(d, kKiteShare));
    const Jet<V> t_jet{t, one, hn::Zero(d)};
    const Jet<V> end_jet{end, one, hn::Zero(d)};
    const V taper = hn::Mul(smoothstep(0.0f, kCurveTaper, t_jet).v, smoothstep(0.0f, kCurveTaper, end_jet).v);

    V sum = hn::Zero(d);
    V first = hn::Zero(d);
    for (std::size_t o = 0; o < kCurveOctaves; ++o) {
      const V noise = hn::Sub(on_circle(d, circles[o], t), cut[o]);
      sum = hn::Add(sum, hn::Mul(noise, hn::Set(d, circles[o].amplitude_m)));
      if (o == 0) first = sum;
    }
    hn::StoreU(bent(d, sum, width, taper), d, full + i);
    hn::StoreU(bent(d, first, width, taper), d, broad + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(fault_curve_target);

int curve_samples(double length_m) {
  int samples = kCurveSamplesMin;
  while (samples < kCurveSamplesMax && samples * kCurveStep_m < length_m) samples *= 2;
  return samples;
}

void fault_curve(const CurveTerms& terms, float* full, float* broad) {
  std::array<CurveCircle, kCurveOctaves> circles;
  double cells = std::max(kCurveCellsMin, static_cast<double>(terms.length_m) / static_cast<double>(terms.wiggle_m));
  double amplitude_m = static_cast<double>(terms.wiggle) * static_cast<double>(terms.length_m);
  for (std::size_t o = 0; o < kCurveOctaves; ++o) {
    const std::uint64_t hash = mix64(terms.seed, o);
    const auto offset = [&](int shift) { return static_cast<float>((hash >> shift) & 0xFFFF) * 0x1p-8f; };
    circles[o] = {static_cast<float>(cells / (2 * std::numbers::pi)), offset(0), offset(16),
                  static_cast<float>(amplitude_m), static_cast<std::uint32_t>(hash >> 32)};
    cells *= kCurveLacunarity;
    amplitude_m *= kCurveGain;
  }
  HWY_DYNAMIC_DISPATCH(fault_curve_target)(terms, circles.data(), full, broad);
}

float curve_at(const float* curve, int samples, float t) {
  const float position = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(samples);
  const float whole = std::floor(position);
  const float f = position - whole;
  const float* p = curve + kCurveBefore + static_cast<std::ptrdiff_t>(whole);
  const float m0 = 0.5f * (p[1] - p[-1]);
  const float m1 = 0.5f * (p[2] - p[0]);
  const float rise = p[1] - p[0];
  const float c2 = 3.0f * rise - (m0 + m0) - m1;
  const float c3 = (m0 + m1) - (rise + rise);
  return p[0] + f * (m0 + f * (c2 + f * c3));
}

}  // namespace talus
#endif  // HWY_ONCE
