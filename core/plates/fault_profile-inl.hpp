// What a fault does to the ground at a signed distance from it, with its slope.
// Include inside a file that Highway compiles once per target.
//
// Every profile is one function of the signed distance, positive on the front plate, so both plates of a fault agree.
// Lengths are in metres of a fault at full width; the caller scales.

#if defined(TALUS_FAULT_PROFILE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_FAULT_PROFILE_INL
#undef TALUS_FAULT_PROFILE_INL
#else
#define TALUS_FAULT_PROFILE_INL
#endif

#include "core/base/jet-inl.hpp"
#include "core/plates/macro_nodes.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Shares of a fault's crest, trench and hilliness at one distance.
template <class V>
struct FaultShape {
  Jet<V> uplift, trench, hilliness;
};

template <class V>
HWY_INLINE Jet<V> constant_jet(float v) {
  const hn::DFromV<V> d;
  return {hn::Set(d, v), hn::Zero(d), hn::Zero(d)};
}

/// 1 at or below `low`, 0 at or above `high`.
template <class V>
HWY_INLINE Jet<V> falling(float low, float high, const Jet<V>& a) {
  return constant_jet<V>(1.0f) - smoothstep(low, high, a);
}

/// Height of a range's flank, 1 at its crest and 0 at its feet: concave foot, sharp crest, which is the one crease
/// that is meant. (1 - t)^2 (0.55 (1 + 2t) + 0.45) at t = the share of the way down.
template <class V>
HWY_INLINE Jet<V> flank(const Jet<V>& s, float crest, float front_foot, float back_foot) {
  const hn::DFromV<V> d;
  const Jet<V> from_crest = s + -crest;
  const V width = hn::IfThenElse(hn::Lt(from_crest.v, hn::Zero(d)), hn::Set(d, 1.0f / (back_foot - crest)),
                                 hn::Set(d, 1.0f / (front_foot - crest)));
  const V t = hn::Min(hn::Mul(from_crest.v, width), hn::Set(d, 1.0f));
  const V left = hn::Sub(hn::Set(d, 1.0f), t);
  const V inner = hn::Add(hn::Set(d, 1.0f), hn::Mul(t, hn::Set(d, 1.1f)));
  // Derivative of left^2 inner: left (1.1 left - 2 inner).
  const V slope = hn::Mul(left, hn::Sub(hn::Mul(left, hn::Set(d, 1.1f)), hn::Add(inner, inner)));
  return chained(from_crest, hn::Mul(hn::Mul(left, left), inner), hn::Mul(slope, width));
}

template <class V>
HWY_INLINE FaultShape<V> shape_of(FaultClass kind, const Jet<V>& s) {
  const Jet<V> zero = constant_jet<V>(0.0f);
  switch (kind) {
    case FaultClass::kCollision: {
      const Jet<V> away = abs(s);
      const Jet<V> ranges = bell(s + -2100.0f, 2300.0f) + bell(s + 2100.0f, 2300.0f);
      return {falling(2600.0f, 6800.0f, away) * 0.62f + ranges * 0.38f, zero, falling(3500.0f, 7000.0f, away)};
    }
    case FaultClass::kSubduction:
      return {flank(s, 3700.0f, 7900.0f, 0.0f), bell(s + 1500.0f, 2400.0f),
              smoothstep(-400.0f, 1800.0f, s) * falling(4200.0f, 8400.0f, s)};
    case FaultClass::kIslandArc:
      return {bell(s + -2400.0f, 3000.0f), bell(s + 1300.0f, 2300.0f), bell(s + -2400.0f, 3300.0f)};
    case FaultClass::kOceanRidge:
      return {bell(s, 5200.0f) - bell(s, 700.0f) * 0.35f, zero, bell(s, 4200.0f)};
    case FaultClass::kRift: {
      const Jet<V> shoulders = abs(s) + -2300.0f;
      return {bell(shoulders, 2100.0f) - bell(s, 1700.0f) * 1.25f, zero, bell(shoulders, 2500.0f)};
    }
    case FaultClass::kOldLand:
      return {bell(s, 4200.0f), zero, bell(s, 4800.0f)};
    case FaultClass::kOldSea:
      return {bell(s, 4200.0f), zero, bell(s, 4200.0f)};
    case FaultClass::kPassive:
      return {zero, zero, bell(s + -3000.0f, 5200.0f)};
  }
  return {zero, zero, zero};
}

/// The ground without what the fault raises: between two continents or two sea floors a slow passage; between land and
/// sea a shelf that rises from the fault through the shore to the plain, and a slope that falls to the sea floor.
template <class V>
HWY_INLINE Jet<V> base_of(const PlateFault& fault, const ShelfTerms& coast, const Jet<V>& s) {
  const hn::DFromV<V> d;
  const FaultClass kind = fault.features.kind;
  if (kind != FaultClass::kSubduction && kind != FaultClass::kPassive) {
    const bool is_land = kind == FaultClass::kCollision || kind == FaultClass::kRift || kind == FaultClass::kOldLand;
    const float reach = is_land ? 4500.0f : 6000.0f;
    return smoothstep(-reach, reach, s) * (fault.front_m - fault.back_m) + fault.back_m;
  }
  // min(x, 1) with a quadratic shoulder over 1 - r .. 1 + r: x - (x - 1 + r)^2 / 4r there.
  constexpr float kShoulder = 0.25f;
  const V x = hn::Max(hn::Mul(s.v, hn::Set(d, coast.per_shelf)), hn::Zero(d));
  const V over = hn::Min(hn::Max(hn::Sub(x, hn::Set(d, 1 - kShoulder)), hn::Zero(d)), hn::Set(d, 2 * kShoulder));
  const V bent =
      hn::Sub(hn::Min(x, hn::Set(d, 1 + kShoulder)), hn::Mul(hn::Mul(over, over), hn::Set(d, 1 / (4 * kShoulder))));
  const V bent_slope = hn::IfThenElseZero(
      hn::And(hn::Gt(s.v, hn::Zero(d)), hn::Lt(x, hn::Set(d, 1 + kShoulder))),
      hn::Mul(hn::Sub(hn::Set(d, 1.0f), hn::Mul(over, hn::Set(d, 1 / (2 * kShoulder)))), hn::Set(d, coast.per_shelf)));
  const Jet<V> inland = chained(s, bent, bent_slope);
  const Jet<V> seaward = falling(-coast.slope_m, 0.0f, s);
  return inland * (fault.front_m + coast.shelf_depth_m) + seaward * (fault.back_m + coast.shelf_depth_m) +
         -coast.shelf_depth_m;
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_FAULT_PROFILE_INL
