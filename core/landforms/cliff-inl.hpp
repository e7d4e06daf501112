// The remap that makes sea cliffs: raw height and lift in, height out, slopes by the chain rule.
//
// Problem: carving a gentle coast into caves and arches gives nothing, and noise has no walls. Answer: where the raw
// height r crosses the sea, all that lies above is lifted by C: h = r + C * smoothstep(-1, 2.4, r). A raw slope of 0.1
// becomes a wall of slope 2, and the finest wrinkles of r become its buttresses. Inland the lift is worn off again, so
// that ranges stay what they were. h rises with r everywhere: an interval of r passes through.
// Include inside a file that Highway compiles once per target.

#if defined(TALUS_CLIFF_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_CLIFF_INL
#undef TALUS_CLIFF_INL
#else
#define TALUS_CLIFF_INL
#endif

#include "core/base/jet-inl.hpp"
#include "core/landforms/coast.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The coast's height from its raw height. `lift` is the cliff's height C in metres, 0..kCliffMax_m; `shelf` is the
/// share of its depth that the sea floor near the coast keeps, 0 < shelf <= 1. Identity, bit for bit, outside
/// -kShelfReach_m .. kCliffReach_m. `stands` is the lift that is left inland and under water: a cliff's height near it.
template <class V>
HWY_INLINE Jet<V> cliff_remap(const Jet<V>& raw, const Jet<V>& lift, const Jet<V>& shelf, V& stands) {
  const hn::DFromV<V> d;
  const Jet<V> wall = smoothstep(kCliffFoot_m, kCliffRim_m, raw);
  const Jet<V> worn = smoothstep(kCliffInland_m, kCliffReach_m, raw) * -1.0f + 1.0f;
  const Jet<V> deep = smoothstep(-kShelfReach_m, 0.0f, raw);  // 0 at sea, 1 at the shore
  const auto under = hn::Lt(raw.v, hn::Zero(d));
  const Jet<V> below{hn::IfThenElseZero(under, raw.v), hn::IfThenElseZero(under, raw.x),
                     hn::IfThenElseZero(under, raw.z)};
  const Jet<V> moved = raw + lift * wall * worn + below * deep * (shelf + -1.0f);
  stands = hn::Mul(lift.v, hn::Mul(worn.v, deep.v));
  const auto within = hn::And(hn::Gt(raw.v, hn::Set(d, -kShelfReach_m)), hn::Lt(raw.v, hn::Set(d, kCliffReach_m)));
  return {hn::IfThenElse(within, moved.v, raw.v), hn::IfThenElse(within, moved.x, raw.x),
          hn::IfThenElse(within, moved.z, raw.z)};
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_CLIFF_INL
