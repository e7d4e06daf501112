#include "core/world/relief.hpp"

#ifndef TALUS_RELIEF_CONSTANTS
#define TALUS_RELIEF_CONSTANTS
namespace talus {

/// Hardness that leaves erosion as strong as the manifest says.
inline constexpr float kMeanHardness = 0.55f;
/// Resistance of 1 in large gullies, and in fine ones. Large ones are as deep as formations are thick: were they to
/// follow the rock at once, valley floors would climb and fall.
inline constexpr float kResistWide = 0.57f;
inline constexpr float kResistFine = 2.2f;
/// The shore is where erosion left it, whatever the rock: beds set in between these heights, in metres.
inline constexpr float kResistLow_m = 5.0f;
inline constexpr float kResistHigh_m = 70.0f;
/// Folds of ranges over those of plains.
inline constexpr float kRangeFolds = 4.0f;
/// Slope of the folds' noise from which one fashion of ledges rules alone: its standard deviation and a little more.
inline constexpr float kFashionSlope = 8e-4f;

}  // namespace talus
#endif  // TALUS_RELIEF_CONSTANTS

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/world/relief.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct JetArrays {
  const float *v, *x, *z;
};
template <class D, class V = VecOf<D>>
HWY_INLINE Jet<V> load(D d, const JetArrays& a, std::size_t i) {
  return {hn::LoadU(d, a.v + i), hn::LoadU(d, a.x + i), hn::LoadU(d, a.z + i)};
}

void relief_row_target(const ReliefTerms& t, const ReliefRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const Jet<V> hilliness = load(d, {r.hilliness, r.hilliness_x, r.hilliness_z}, i);
    const Jet<V> macro = load(d, {r.height, r.slope_x, r.slope_z}, i);
    const Jet<V> hills = load(d, {r.hills.v, r.hills.x, r.hills.z}, i);
    // The sea floor is smooth: hills sink from the shore to the deep.
    const Jet<V> dry_land = smoothstep(-240.0f, -40.0f, macro) * 0.8f + 0.2f;
    const Jet<V> amplitude = (hilliness * t.hill_high_m + t.hill_base_m) * dry_land;
    const Jet<V> height = macro + hills * amplitude;

    // Where between the valleys and the peaks around this point lies: -1 .. +1, and a little beyond.
    const V floor = hn::LoadU(d, r.floor + i);
    const V valley = hn::Sub(floor, hn::Mul(amplitude.v, hn::Set(d, 0.35f)));
    const V span =
        hn::Add(hn::LoadU(d, r.lift + i), hn::Add(hn::Mul(amplitude.v, hn::Set(d, 0.85f)), hn::Set(d, 60.0f)));
    const V altitude = hn::Sub(hn::Div(hn::Mul(hn::Set(d, 2.0f), hn::Sub(height.v, valley)), span), hn::Set(d, 1.0f));
    const V clamped = hn::Min(hn::Max(altitude, hn::Set(d, -1.5f)), hn::Set(d, 1.5f));
    const V fade = hn::Add(hn::Mul(clamped, hn::Set(d, t.fade_altitude)), hn::Mul(hills.v, hn::Set(d, t.fade_relief)));

    // Strength: by hilliness, a little by altitude, and fading out under water.
    const V dry = smoothstep(-120.0f, -10.0f, height).v;
    const V high = smoothstep(60.0f, 300.0f, height).v;
    const V hilly = pow_unit(d, saturate(hilliness.v), hn::Set(d, 0.8f));
    const V wear = hn::Add(hn::Add(hn::Set(d, t.plain_strength), hn::Mul(hilly, hn::Set(d, t.hill_strength))),
                           hn::Mul(high, hn::Set(d, 0.12f)));
    hn::StoreU(height.v, d, r.height + i);
    hn::StoreU(height.x, d, r.slope_x + i);
    hn::StoreU(height.z, d, r.slope_z + i);
    hn::StoreU(fade, d, r.fade + i);
    hn::StoreU(hn::Mul(saturate(wear), dry), d, r.strength + i);
  }
}

void strata_place_row_target(const WorldFunction::Terms& t, const StrataPlace& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  const auto last = hn::Set(d, static_cast<float>(t.strata->sets() - 1));
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto scaled = [&](const float* noise, float by) { return hn::Mul(hn::LoadU(d, noise + i), hn::Set(d, by)); };
    const auto hilly = saturate(hn::LoadU(d, r.hilliness + i));
    const auto folds = hn::Add(hn::Set(d, 1.0f), hn::Mul(hn::Mul(hilly, hilly), hn::Set(d, kRangeFolds - 1.0f)));
    const auto bent = hn::Add(hn::Mul(scaled(r.fold, t.fold_m), folds), scaled(r.tilt, t.tilt_m));
    hn::StoreU(hn::Add(bent, hn::Set(d, kStackTop)), d, r.stack + i);
    const auto share = saturate(hn::Add(scaled(r.set_choice, 0.9f), hn::Set(d, 0.5f)));
    hn::StoreU(hn::Mul(share, last), d, r.choice + i);
    const auto fashion = saturate(hn::Add(scaled(r.fold_x, 0.5f / kFashionSlope), hn::Set(d, 0.5f)));
    hn::StoreU(fashion, d, r.fashion + i);
  }
}

void resist_row_target(float resistance, const float* hardness, float* strength, std::size_t width) {
  const hn::ScalableTag<float> d;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto softer = hn::Sub(hn::Set(d, kMeanHardness), hn::LoadU(d, hardness + i));
    const auto factor = hn::Add(hn::Set(d, 1.0f), hn::Mul(softer, hn::Set(d, kResistWide * resistance)));
    hn::StoreU(hn::Mul(hn::LoadU(d, strength + i), factor), d, strength + i);
  }
}

void withstand_row_target(float resistance, const WithstandRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V one = hn::Set(d, 1.0f);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const V height = hn::LoadU(d, r.height + i);
    const V harder = hn::Sub(hn::LoadU(d, r.hardness + i), hn::Set(d, kMeanHardness));
    const V wanted = hn::Mul(harder, hn::Set(d, kResistFine * resistance));
    const V above = smoothstep(kResistLow_m, kResistHigh_m, Jet<V>{height, hn::Zero(d), hn::Zero(d)}).v;
    const V kept = hn::Mul(hn::Min(hn::Max(wanted, hn::Neg(one)), one), above);
    const auto add = [&](const float* cut, float* to) {
      hn::StoreU(hn::Add(hn::LoadU(d, to + i), hn::Mul(kept, hn::LoadU(d, cut + i))), d, to + i);
    };
    add(r.cut, r.height);
    add(r.cut_x, r.slope_x);
    add(r.cut_z, r.slope_z);
  }
}

void add_change_row_target(const ChangeRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto add = [&](const float* change, float* to) {
      hn::StoreU(hn::Add(hn::LoadU(d, to + i), hn::LoadU(d, change + i)), d, to + i);
    };
    add(r.height_change, r.height);
    add(r.x_change, r.slope_x);
    add(r.z_change, r.slope_z);
  }
}

void surface_row_target(const SurfaceLimits& t, const SurfaceRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  const auto one = hn::Set(d, 1.0f);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto height = hn::LoadU(d, r.height + i);
    hn::StoreU(hn::Min(hn::Max(height, hn::Set(d, t.low_m)), hn::Set(d, t.high_m)), d, r.height + i);
    const auto slope_x = hn::LoadU(d, r.slope_x + i);
    const auto slope_z = hn::LoadU(d, r.slope_z + i);
    const auto square = hn::Add(hn::Mul(slope_x, slope_x), hn::Mul(slope_z, slope_z));
    hn::StoreU(hn::Div(one, hn::Sqrt(hn::Add(one, square))), d, r.steepness + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(relief_row_target);
HWY_EXPORT(strata_place_row_target);
HWY_EXPORT(resist_row_target);
HWY_EXPORT(withstand_row_target);
HWY_EXPORT(add_change_row_target);
HWY_EXPORT(surface_row_target);

void relief_row(const ReliefTerms& terms, const ReliefRow& row, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(relief_row_target)(terms, row, width);
}

void strata_place_row(const WorldFunction::Terms& terms, const StrataPlace& row, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(strata_place_row_target)(terms, row, width);
}

void resist_row(float resistance, const float* hardness, float* strength, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(resist_row_target)(resistance, hardness, strength, width);
}

void withstand_row(float resistance, const WithstandRow& row, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(withstand_row_target)(resistance, row, width);
}

void add_change_row(const ChangeRow& row, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(add_change_row_target)(row, width);
}

void surface_row(const SurfaceLimits& limits, const SurfaceRow& row, std::size_t width) {
  HWY_DYNAMIC_DISPATCH(surface_row_target)(limits, row, width);
}

}  // namespace talus
#endif  // HWY_ONCE
