#include "core/volume/field_rows.hpp"

#include "core/volume/controls.hpp"
#include "core/volume/warp.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/volume/field_rows.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// min(a, b) rounded over a width k; equal to it where they differ by k or more.
template <class V>
HWY_INLINE V smooth_min(V a, V b, float k) {
  const hn::DFromV<V> d;
  const V h = hn::Max(hn::Sub(hn::Set(d, k), hn::Abs(hn::Sub(a, b))), hn::Zero(d));
  return hn::Sub(hn::Min(a, b), hn::Mul(hn::Mul(h, h), hn::Set(d, 0.25f / k)));
}
template <class V>
HWY_INLINE V smooth_max(V a, V b, float k) {
  const hn::DFromV<V> d;
  const V h = hn::Max(hn::Sub(hn::Set(d, k), hn::Abs(hn::Sub(a, b))), hn::Zero(d));
  return hn::Add(hn::Max(a, b), hn::Mul(hn::Mul(h, h), hn::Set(d, 0.25f / k)));
}

void smooth_row_target(float y_m, const float* HWY_RESTRICT height, const float* HWY_RESTRICT steepness,
                       std::size_t width, float* HWY_RESTRICT out) {
  const hn::ScalableTag<float> d;
  const auto y = hn::Set(d, y_m);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    hn::StoreU(hn::Mul(hn::Sub(y, hn::LoadU(d, height + i)), hn::LoadU(d, steepness + i)), d, out + i);
  }
}

void warped_row_target(float y_m, const WarpRow& r, std::size_t width, float* HWY_RESTRICT out) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V y = hn::Set(d, y_m);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    V rise = hn::Mul(hn::LoadU(d, r.jut + i), hn::LoadU(d, r.proud + i));
    if (r.still_x != nullptr) {
      const V dx = hn::LoadU(d, r.still_x + i);
      const V away = hn::Sqrt(hn::Add(hn::Mul(dx, dx), hn::Set(d, r.still2)));
      const V t = hn::Min(hn::Mul(away, hn::Set(d, 1.0f / kWarpStillRadius_m)), hn::Set(d, 1.0f));
      const V shown = hn::Mul(hn::Mul(t, t), hn::Sub(hn::Set(d, 3.0f), hn::Add(t, t)));
      rise = hn::Mul(rise, shown);
    }
    const V surface = hn::Add(hn::LoadU(d, r.height + i), rise);
    hn::StoreU(hn::Mul(hn::Sub(y, surface), hn::LoadU(d, r.steepness + i)), d, out + i);
  }
}

void sphere_row_target(const SphereRow& r, std::size_t first, std::size_t end, float* HWY_RESTRICT distance) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = first / lanes * lanes; i < end; i += lanes) {
    // Sums of multiples of 1/64 m far below 2^24 of them: exact, whatever the first sample is.
    const V dx =
        hn::Add(hn::Set(d, r.dx_m + static_cast<float>(i) * r.step_m), hn::Mul(hn::Iota(d, 0), hn::Set(d, r.step_m)));
    const V away = hn::Sqrt(hn::Add(hn::Mul(dx, dx), hn::Set(d, r.rest2)));
    const V wall = hn::Sub(away, hn::Set(d, r.radius_m));
    const V before = hn::LoadU(d, distance + i);
    const V joined = smooth_min(before, wall, r.union_m);
    hn::StoreU(hn::IfThenElse(hn::Lt(wall, hn::Set(d, kCarveBand_m)), joined, before), d, distance + i);
  }
}

bool any_rough_target(const float* HWY_RESTRICT distance, std::size_t width) {
  const hn::ScalableTag<float> d;
  bool any = false;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    any = any || !hn::AllFalse(d, hn::Lt(hn::Abs(hn::LoadU(d, distance + i)), hn::Set(d, kRoughEnd_m)));
  }
  return any;
}

/// Distance to carved space outside the pillar around the still column that is `away` from the sample, and whose end is
/// `level` from it. Infinite at the column itself, so that nothing at all is carved there.
template <class V>
HWY_INLINE V outside_pillar(V distance, V away2, V level2) {
  constexpr float radius = kPillar_m;
  const hn::DFromV<V> d;
  const auto within = [&](V square) {
    const V inside =
        hn::Mul(hn::Sub(hn::Div(hn::Set(d, radius * radius), hn::Max(square, hn::Set(d, 1e-12f))), hn::Set(d, 1.0f)),
                hn::Set(d, 0.5f * radius));
    const V outside = hn::Sub(hn::Set(d, radius), hn::Sqrt(square));
    return hn::IfThenElse(hn::Lt(square, hn::Set(d, radius * radius)), inside, outside);
  };
  const V pillar = smooth_min(within(away2), within(level2), 1.0f);
  // Out of reach of the deepest point of a cave the pillar is not there.
  const V reach = hn::Set(d, 144.0f);
  return hn::IfThenElse(hn::Lt(away2, reach), smooth_max(distance, pillar, 1.0f), distance);
}

/// By how much samples count as nearer to carved space than they are: 0 in a column's own rock, kFront_m where its
/// hardest bed ends. Fades out over the band's last metre.
template <class V>
HWY_INLINE V in_front(V distance, V above, V jut) {
  const hn::DFromV<V> d;
  const V out = saturate(hn::Div(above, hn::Max(jut, hn::Set(d, 1e-3f))));
  const V near = saturate(hn::Sub(hn::Set(d, kCarveBand_m), distance));
  return hn::IfThenElseZero(hn::Gt(jut, hn::Zero(d)), hn::Mul(hn::Mul(out, near), hn::Set(d, kFront_m)));
}

void subtract_row_target(const CarvedRow& r, std::size_t width, float* HWY_RESTRICT density) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V band = hn::Set(d, kCarveBand_m);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    V c = hn::LoadU(d, r.distance + i);
    if (r.noise != nullptr) {
      const V fade = saturate(
          hn::Mul(hn::Sub(hn::Set(d, kRoughEnd_m), hn::Abs(c)), hn::Set(d, 1.0f / (kRoughEnd_m - kRoughFull_m))));
      c = hn::Add(c, hn::Mul(hn::Mul(hn::LoadU(d, r.noise + i), hn::Set(d, r.roughness_m)), fade));
    }
    if (r.jut != nullptr) {
      const V above = hn::Sub(hn::Set(d, r.y_m), hn::LoadU(d, r.height + i));
      c = hn::Sub(c, in_front(c, above, hn::LoadU(d, r.jut + i)));
    }
    const V dx = hn::LoadU(d, r.still_x + i);
    c = outside_pillar(c, hn::Add(hn::Mul(dx, dx), hn::Set(d, r.still_z * r.still_z)),
                       hn::Set(d, r.still_y * r.still_y));
    // Away from carved space the distance to it grows to infinity at the band's end, with slope 1 at the wall.
    const V left = hn::Max(hn::Sub(band, c), hn::Set(d, 1e-6f));
    const V grown = hn::Div(hn::Mul(c, band), left);
    const V wall = hn::IfThenElse(hn::Gt(c, hn::Zero(d)), grown, c);
    const V before = hn::LoadU(d, density + i);
    const V after = smooth_max(before, hn::Neg(wall), r.blend_m);
    hn::StoreU(hn::IfThenElse(hn::Lt(c, band), after, before), d, density + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(smooth_row_target);
HWY_EXPORT(warped_row_target);
HWY_EXPORT(sphere_row_target);
HWY_EXPORT(any_rough_target);
HWY_EXPORT(subtract_row_target);

void smooth_row(float y_m, const float* height, const float* steepness, std::size_t width, float* out) {
  HWY_DYNAMIC_DISPATCH(smooth_row_target)(y_m, height, steepness, width, out);
}
void warped_row(float y_m, const WarpRow& row, std::size_t width, float* out) {
  HWY_DYNAMIC_DISPATCH(warped_row_target)(y_m, row, width, out);
}
void sphere_row(const SphereRow& row, std::size_t first, std::size_t end, float* distance) {
  HWY_DYNAMIC_DISPATCH(sphere_row_target)(row, first, end, distance);
}
bool any_rough(const float* distance, std::size_t width) {
  return HWY_DYNAMIC_DISPATCH(any_rough_target)(distance, width);
}
void subtract_row(const CarvedRow& row, std::size_t width, float* density) {
  HWY_DYNAMIC_DISPATCH(subtract_row_target)(row, width, density);
}

}  // namespace talus
#endif  // HWY_ONCE
