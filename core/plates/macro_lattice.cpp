#include "core/plates/macro_lattice.hpp"

#include <algorithm>

#include "core/base/check.hpp"
#include "core/grid/floor_div.hpp"
#include "core/plates/macro_field.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plates/macro_lattice.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Hermite's four polynomials at t and their derivatives: values and slopes at 0 and 1. At t = 0 all are exactly 0 but
/// value_0 and slope_0', which are 1.
template <class V>
struct Hermite {
  V value_0, value_1, slope_0, slope_1;
};
template <class D, class V = VecOf<D>>
HWY_INLINE Hermite<V> hermite(D d, V t) {
  const V left = hn::Sub(hn::Set(d, 1.0f), t);
  const V value_1 = hn::Mul(hn::Mul(t, t), hn::Sub(hn::Set(d, 3.0f), hn::Add(t, t)));
  return {hn::Sub(hn::Set(d, 1.0f), value_1), value_1, hn::Mul(t, hn::Mul(left, left)),
          hn::Neg(hn::Mul(hn::Mul(t, t), left))};
}
template <class D, class V = VecOf<D>>
HWY_INLINE Hermite<V> hermite_slopes(D d, V t) {
  const V left = hn::Sub(hn::Set(d, 1.0f), t);
  const V value_1 = hn::Mul(hn::Set(d, 6.0f), hn::Mul(t, left));
  const V three_t = hn::Mul(t, hn::Set(d, 3.0f));
  return {hn::Neg(value_1), value_1, hn::Mul(left, hn::Sub(hn::Set(d, 1.0f), three_t)),
          hn::Mul(t, hn::Sub(three_t, hn::Set(d, 2.0f)))};
}

void interpolate_row_target(const NodeAxis& axis, const NodeArrays& before, const NodeArrays& after, float fraction_z,
                            float spacing_m, std::size_t width, float* out, float* out_x, float* out_z) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  using V = hn::Vec<decltype(d)>;
  const V spacing = hn::Set(d, spacing_m);
  const V per_spacing = hn::Set(d, 1.0f / spacing_m);
  const V t_z = hn::Set(d, fraction_z);
  const Hermite<V> z = hermite(d, t_z);
  const Hermite<V> dz = hermite_slopes(d, t_z);

  // Along z, at each column of nodes: value and slope x, and what they do per spacing along z.
  alignas(64) std::array<float, kColumnsMax + 1> value;
  alignas(64) std::array<float, kColumnsMax + 1> slope;
  alignas(64) std::array<float, kColumnsMax + 1> value_z;
  alignas(64) std::array<float, kColumnsMax + 1> slope_z;
  const auto nodes = static_cast<std::size_t>(axis.nodes);
  for (std::size_t i = 0; i < nodes; i += hn::Lanes(d)) {
    const V v0 = hn::LoadU(d, before.v + i);
    const V v1 = hn::LoadU(d, after.v + i);
    const V x0 = hn::Mul(hn::LoadU(d, before.x + i), spacing);
    const V x1 = hn::Mul(hn::LoadU(d, after.x + i), spacing);
    const V z0 = hn::Mul(hn::LoadU(d, before.z + i), spacing);
    const V z1 = hn::Mul(hn::LoadU(d, after.z + i), spacing);
    const auto along = [&](const Hermite<V>& h) {
      return hn::Add(hn::Add(hn::Mul(v0, h.value_0), hn::Mul(v1, h.value_1)),
                     hn::Add(hn::Mul(z0, h.slope_0), hn::Mul(z1, h.slope_1)));
    };
    const auto across = [&](const Hermite<V>& h) { return hn::Add(hn::Mul(x0, h.value_0), hn::Mul(x1, h.value_1)); };
    hn::Store(along(z), d, &value[i]);
    hn::Store(along(dz), d, &value_z[i]);
    hn::Store(across(z), d, &slope[i]);
    hn::Store(across(dz), d, &slope_z[i]);
  }
  // The column after the last node is only looked at with weight 0.
  for (auto* array : {&value, &slope, &value_z, &slope_z}) (*array)[nodes] = (*array)[nodes - 1];

  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto left = hn::Load(di, &axis.left[i]);
    const V t = hn::Load(d, &axis.fraction[i]);
    const Hermite<V> x = hermite(d, t);
    const auto sum = [&](const Hermite<V>& h, V v0, V v1, V s0, V s1) {
      return hn::Add(hn::Add(hn::Mul(v0, h.value_0), hn::Mul(v1, h.value_1)),
                     hn::Add(hn::Mul(s0, h.slope_0), hn::Mul(s1, h.slope_1)));
    };
    const V v0 = hn::GatherIndex(d, value.data(), left);
    const V v1 = hn::GatherIndex(d, value.data() + 1, left);
    const V s0 = hn::GatherIndex(d, slope.data(), left);
    const V s1 = hn::GatherIndex(d, slope.data() + 1, left);
    hn::StoreU(sum(x, v0, v1, s0, s1), d, out + i);
    if (out_x == nullptr) continue;
    hn::StoreU(hn::Mul(sum(hermite_slopes(d, t), v0, v1, s0, s1), per_spacing), d, out_x + i);
    const V v0_z = hn::GatherIndex(d, value_z.data(), left);
    const V v1_z = hn::GatherIndex(d, value_z.data() + 1, left);
    const V s0_z = hn::GatherIndex(d, slope_z.data(), left);
    const V s1_z = hn::GatherIndex(d, slope_z.data() + 1, left);
    hn::StoreU(hn::Mul(sum(x, v0_z, v1_z, s0_z, s1_z), per_spacing), d, out_z + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(interpolate_row_target);

bool lies_on_lattice(std::int64_t start_voxel, std::int64_t step_voxel) {
  return step_voxel < kMacroNodeVoxels || (step_voxel % kMacroNodeVoxels == 0 && start_voxel % kMacroNodeVoxels == 0);
}

NodeAxis node_axis(std::int64_t start_voxel, std::int64_t step_voxel, int count) {
  TALUS_CHECK(lies_on_lattice(start_voxel, step_voxel));
  NodeAxis out;
  if (step_voxel >= kMacroNodeVoxels) {
    out.first_voxel = start_voxel;
    out.step_voxel = step_voxel;
    out.nodes = count;
    for (int i = 0; i < count; ++i) out.left[static_cast<std::size_t>(i)] = i;
    return out;
  }
  const std::int64_t first = floor_div(start_voxel, kMacroNodeVoxels);
  for (int i = 0; i < count; ++i) {
    const std::int64_t at = start_voxel + i * step_voxel;
    const std::int64_t node = floor_div(at, kMacroNodeVoxels);
    out.left[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(node - first);
    out.fraction[static_cast<std::size_t>(i)] =
        static_cast<float>(at - node * kMacroNodeVoxels) * (1.0f / static_cast<float>(kMacroNodeVoxels));
  }
  out.first_voxel = first * kMacroNodeVoxels;
  out.step_voxel = kMacroNodeVoxels;
  out.nodes = out.left[static_cast<std::size_t>(count - 1)] + 2;
  return out;
}

void interpolate_row(const NodeAxis& x, const NodeArrays& before, const NodeArrays& after, float fraction_z,
                     float spacing_m, std::size_t width, float* out, float* out_x, float* out_z) {
  HWY_DYNAMIC_DISPATCH(interpolate_row_target)
  (x, before, after, fraction_z, spacing_m, width, out, out_x, out_z);
}

}  // namespace talus
#endif  // HWY_ONCE
