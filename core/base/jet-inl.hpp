// A value with its gradient in x and z, so that slopes leave every formula together with heights.
// Include inside a file that Highway compiles once per target.

#if defined(TALUS_JET_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_JET_INL
#undef TALUS_JET_INL
#else
#define TALUS_JET_INL
#endif

#include "core/base/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Jet {
  V v, x, z;  ///< value, d/dx, d/dz
};

template <class V>
HWY_INLINE Jet<V> operator+(const Jet<V>& a, const Jet<V>& b) {
  return {hn::Add(a.v, b.v), hn::Add(a.x, b.x), hn::Add(a.z, b.z)};
}
template <class V>
HWY_INLINE Jet<V> operator-(const Jet<V>& a, const Jet<V>& b) {
  return {hn::Sub(a.v, b.v), hn::Sub(a.x, b.x), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Jet<V> operator*(const Jet<V>& a, const Jet<V>& b) {
  return {hn::Mul(a.v, b.v), hn::Add(hn::Mul(a.x, b.v), hn::Mul(a.v, b.x)),
          hn::Add(hn::Mul(a.z, b.v), hn::Mul(a.v, b.z))};
}
template <class V>
HWY_INLINE Jet<V> operator*(const Jet<V>& a, float k) {
  const V s = hn::Set(hn::DFromV<V>(), k);
  return {hn::Mul(a.v, s), hn::Mul(a.x, s), hn::Mul(a.z, s)};
}
template <class V>
HWY_INLINE Jet<V> operator+(const Jet<V>& a, float k) {
  return {hn::Add(a.v, hn::Set(hn::DFromV<V>(), k)), a.x, a.z};
}

/// f(a) by the chain rule, given f(a.v) and f'(a.v).
template <class V>
HWY_INLINE Jet<V> chained(const Jet<V>& a, V value, V slope) {
  return {value, hn::Mul(a.x, slope), hn::Mul(a.z, slope)};
}

/// |a|; the slope at 0 is 0.
template <class V>
HWY_INLINE Jet<V> abs(const Jet<V>& a) {
  const hn::DFromV<V> d;
  const V sign = hn::IfThenElseZero(hn::Ne(a.v, hn::Zero(d)), hn::CopySign(hn::Set(d, 1.0f), a.v));
  return chained(a, hn::Abs(a.v), sign);
}

/// a + (b - a) t.
template <class V>
HWY_INLINE Jet<V> mix(const Jet<V>& a, const Jet<V>& b, const Jet<V>& t) {
  return a + (b - a) * t;
}

/// 3t^2 - 2t^3 of t = (a - low) / (high - low) clamped to 0..1.
template <class V>
HWY_INLINE Jet<V> smoothstep(float low, float high, const Jet<V>& a) {
  const hn::DFromV<V> d;
  const float scale = 1.0f / (high - low);
  const V t = saturate(hn::Mul(hn::Sub(a.v, hn::Set(d, low)), hn::Set(d, scale)));
  const V value = hn::Mul(hn::Mul(t, t), hn::Sub(hn::Set(d, 3.0f), hn::Add(t, t)));
  const V slope = hn::Mul(hn::Mul(t, hn::Sub(hn::Set(d, 1.0f), t)), hn::Set(d, 6.0f * scale));
  return chained(a, value, slope);
}

/// (1 - (a / width)^2)^2 within +-width, 0 outside: smooth on both sides.
template <class V>
HWY_INLINE Jet<V> bell(const Jet<V>& a, float width) {
  const hn::DFromV<V> d;
  const V t = hn::Mul(a.v, hn::Set(d, 1.0f / width));
  const V left = hn::Max(hn::Sub(hn::Set(d, 1.0f), hn::Mul(t, t)), hn::Zero(d));
  return chained(a, hn::Mul(left, left), hn::Mul(hn::Mul(left, t), hn::Set(d, -4.0f / width)));
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_JET_INL
