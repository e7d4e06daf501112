// Transcendental functions for the kernels, bit-equal on every SIMD target.
//
// Only add, subtract, multiply, divide, square root, round and integer operations, in one written order, and no fused
// multiply-add: each of these is exact or correctly rounded by IEEE 754, so every target and every lane gives the same
// bits. Include inside a file that Highway compiles once per target. Float lanes; errors are against the exact
// function.

#if defined(TALUS_SIMD_MATH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SIMD_MATH_INL
#undef TALUS_SIMD_MATH_INL
#else
#define TALUS_SIMD_MATH_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
using VecOf = hn::Vec<D>;

/// Horner's rule for c0 + c1 x + c2 x^2 ... in float.
template <class D, class V>
HWY_INLINE V polynomial(D d, V x, float c0) {
  (void)x;
  return hn::Set(d, c0);
}
template <class D, class V, class... Rest>
HWY_INLINE V polynomial(D d, V x, float c0, Rest... rest) {
  return hn::Add(hn::Set(d, c0), hn::Mul(x, polynomial(d, x, rest...)));
}

template <class V>
HWY_INLINE V saturate(V v) {
  const hn::DFromV<V> d;
  return hn::Min(hn::Max(v, hn::Zero(d)), hn::Set(d, 1.0f));
}

/// a + (b - a) t.
template <class V>
HWY_INLINE V mix(V a, V b, V t) {
  return hn::Add(a, hn::Mul(hn::Sub(b, a), t));
}

/// cos and sin of `cycles` full turns, |cycles| < 2^22; absolute error below 1e-6.
/// Half-angle polynomials on [-1/4, 1/4] turn (interpolated at Chebyshev nodes), then one doubling.
template <class D, class V = VecOf<D>>
HWY_INLINE void cos_sin_cycles(D d, V cycles, V& cosine, V& sine) {
  const V t = hn::Sub(cycles, hn::Round(cycles));  // [-1/2, 1/2]
  const V t2 = hn::Mul(t, t);
  // sin(pi t) and cos(pi t) on |t| <= 1/2.
  const V s = hn::Mul(t, polynomial(d, t2, 3.14159264f, -5.16771008f, 2.55007739f, -0.598290411f, 0.0776559123f));
  const V c = polynomial(d, t2, 0.999999953f, -4.93479280f, 4.05841079f, -1.33187297f, 0.219682424f);
  const V s2 = hn::Add(s, s);
  sine = hn::Mul(s2, c);
  cosine = hn::Sub(hn::Set(d, 1.0f), hn::Mul(s2, s));
}

/// e^x for x in [-4.5, 0]; relative error below 2e-6. Callers clamp.
template <class D, class V = VecOf<D>>
HWY_INLINE V exp_to_minus_4_5(D d, V x) {
  // e^(x/8), interpolated at Chebyshev nodes, then three squarings.
  const V y = hn::Mul(x, hn::Set(d, 0.125f));  // [-0.5625, 0]
  V e = polynomial(d, y, 0.999999983f, 0.999997831f, 0.499954745f, 0.166319168f, 0.0404470390f, 0.00630812253f);
  e = hn::Mul(e, e);
  e = hn::Mul(e, e);
  return hn::Mul(e, e);
}

/// log2 of a positive, normal x; absolute error below 3e-6.
/// Mantissa in [sqrt(1/2), sqrt(2)), then 2 atanh((m - 1) / (m + 1)) / ln 2.
template <class D, class V = VecOf<D>>
HWY_INLINE V log2_positive(D d, V x) {
  const hn::RebindToSigned<D> di;
  const auto bits = hn::BitCast(di, x);
  // 0x3F3504F3 is sqrt(1/2): subtracting it leaves the exponent of the nearest mantissa in the top bits.
  const auto shifted = hn::Sub(bits, hn::Set(di, 0x3F3504F3));
  const auto exponent = hn::ShiftRight<23>(shifted);
  const V mantissa = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  const V one = hn::Set(d, 1.0f);
  const V r = hn::Div(hn::Sub(mantissa, one), hn::Add(mantissa, one));
  const V r2 = hn::Mul(r, r);
  const V log = hn::Mul(r, polynomial(d, r2, 2.88539008f, 0.961796694f, 0.577078016f, 0.412198583f));
  return hn::Add(hn::ConvertTo(d, exponent), log);
}

/// 2^x for x in [-126, 126]; relative error below 2e-6.
template <class D, class V = VecOf<D>>
HWY_INLINE V exp2_bounded(D d, V x) {
  const hn::RebindToSigned<D> di;
  const V whole = hn::Round(x);
  const V f = hn::Sub(x, whole);  // [-1/2, 1/2]
  const V p = polynomial(d, f, 1.0f, 0.693147181f, 0.240226507f, 0.0555041087f, 0.00961812911f, 0.00133335581f,
                         0.000154035304f);
  const auto scale = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 127)));
  return hn::Mul(p, hn::BitCast(d, scale));
}

/// 1 / (1 + e^-x) for any x, clamped to |x| <= 60; relative error below 1e-5 (that of e^-60: 60 log2 e has its last bit
/// at 2^-18).
template <class D, class V = VecOf<D>>
HWY_INLINE V logistic(D d, V x) {
  const V clamped = hn::Min(hn::Max(x, hn::Set(d, -60.0f)), hn::Set(d, 60.0f));
  const V power = exp2_bounded(d, hn::Mul(clamped, hn::Set(d, -1.44269504f)));
  return hn::Div(hn::Set(d, 1.0f), hn::Add(hn::Set(d, 1.0f), power));
}

/// x^k for x in [0, 1] and k in (0, 8]; 0 where x is below 2^-15. Relative error below 4e-5 (it grows with k log x).
template <class D, class V = VecOf<D>>
HWY_INLINE V pow_unit(D d, V x, V k) {
  const V smallest = hn::Set(d, 0x1p-15f);
  const V power = exp2_bounded(d, hn::Mul(k, log2_positive(d, hn::Max(x, smallest))));
  return hn::IfThenElseZero(hn::Gt(x, smallest), power);
}

/// 1 - (1 - sat t)^2.
template <class D, class V = VecOf<D>>
HWY_INLINE V ease_out(D d, V t) {
  const V one = hn::Set(d, 1.0f);
  const V v = hn::Sub(one, saturate(t));
  return hn::Sub(one, hn::Mul(v, v));
}

/// Zero slope at 0, slope 1 from r on: t >= r ? t - r / 2 : t^2 / (2 r), for t >= 0, r >= 0.
template <class D, class V = VecOf<D>>
HWY_INLINE V smooth_start(D d, V t, V r) {
  const V half = hn::Set(d, 0.5f);
  const V r_safe = hn::Max(r, hn::Set(d, 1e-9f));
  const V curve = hn::Div(hn::Mul(half, hn::Mul(t, t)), r_safe);
  return hn::IfThenElse(hn::Ge(t, r), hn::Sub(t, hn::Mul(half, r)), curve);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_SIMD_MATH_INL
