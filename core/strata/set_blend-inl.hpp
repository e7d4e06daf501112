// Which two layer sets meet at a column, and how much the second has of it. Include inside a file that Highway compiles
// once per target.

#if defined(TALUS_SET_BLEND_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SET_BLEND_INL
#undef TALUS_SET_BLEND_INL
#else
#define TALUS_SET_BLEND_INL
#endif

#include "core/base/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct SetBlend {
  hn::Vec<hn::RebindToSigned<hn::DFromV<V>>> set;  ///< the first; the next one is the second
  V share;                                         ///< of the second, 0..1
};

/// Sets blend where the fraction of `choice` is within 0.35..0.65.
template <class D, class V = VecOf<D>>
HWY_INLINE SetBlend<V> set_blend(D d, V choice) {
  const hn::RebindToSigned<D> di;
  const V set = hn::Floor(choice);
  const V t = saturate(hn::Mul(hn::Sub(hn::Sub(choice, set), hn::Set(d, 0.35f)), hn::Set(d, 1.0f / 0.3f)));
  return {hn::ConvertTo(di, set), hn::Mul(hn::Mul(t, t), hn::Sub(hn::Set(d, 3.0f), hn::Add(t, t)))};
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_SET_BLEND_INL
