#include "core/landforms/cones.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/noise/gradient_noise.hpp"

#ifndef TALUS_CONE_ROW
#define TALUS_CONE_ROW
namespace talus {

/// Columns of one row that a cone can reach.
struct ConeRow {
  const float* dx;  ///< from the centre, in metres
  float dz;
  const float *sway, *sway_x, *sway_z;
  float *rise, *rise_x, *rise_z;         ///< of the highest cone so far
  float *calm, *shape, *gullies, *bowl;  ///< the most so far; not for cinder cones
  std::size_t width;
};

struct ConeSumRow {
  const float *rise, *rise_x, *rise_z;
  float *height, *slope_x, *slope_z;
};

struct ConeErosionRow {
  const float *height, *calm, *shape, *gullies, *bowl;
  float *fade, *strength, *hilliness;
};

}  // namespace talus
#endif  // TALUS_CONE_ROW

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/landforms/cones.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
HWY_INLINE Jet<V> lower(const Jet<V>& a, const Jet<V>& b) {
  const auto is_a = hn::Lt(a.v, b.v);
  return {hn::IfThenElse(is_a, a.v, b.v), hn::IfThenElse(is_a, a.x, b.x), hn::IfThenElse(is_a, a.z, b.z)};
}

/// (1 - t)^2 (1 + 1.1 t) for t in 0..1, then 0: a concave foot, flanks that steepen, a sharp summit.
template <class V>
HWY_INLINE Jet<V> flank(const Jet<V>& t) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  const V left = hn::Max(hn::Sub(one, t.v), hn::Zero(d));
  const V value = hn::Mul(hn::Mul(left, left), hn::Add(one, hn::Mul(t.v, hn::Set(d, 1.1f))));
  const V slope = hn::Mul(left, hn::Sub(hn::Set(d, -0.9f), hn::Mul(t.v, hn::Set(d, 3.3f))));
  return chained(t, value, slope);
}

/// Loose cinders lie at one angle: straight flanks, a short foot. 1 - t, rounded off over the last fifth.
template <class V>
HWY_INLINE Jet<V> heap(const Jet<V>& t) {
  const hn::DFromV<V> d;
  const Jet<V> left = t * -1.0f + 1.0f;
  const V x = hn::Max(left.v, hn::Zero(d));
  const V r = hn::Set(d, 0.2f);
  const V k = hn::Set(d, 1.0f / 0.9f);  // so that the summit is 1
  const auto at_foot = hn::Lt(x, r);
  const V curve = hn::Mul(hn::Mul(x, x), hn::Set(d, 2.5f));  // x^2 / (2 r)
  const V value = hn::IfThenElse(at_foot, curve, hn::Sub(x, hn::Set(d, 0.1f)));
  const V slope = hn::IfThenElse(at_foot, hn::Mul(x, hn::Set(d, 5.0f)), hn::Set(d, 1.0f));
  return chained(left, hn::Mul(value, k), hn::Mul(slope, k));
}

void cone_row(const Cone& cone, const ConeRow& r) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d);
  const V dz = hn::Set(d, r.dz);
  // flank at the crater's rim, where the bowl takes over.
  const float c = cone.crater;
  const float rim = cone.is_cinder ? (1 - c - 0.1f) / 0.9f : (1 - c) * (1 - c) * (1 + 1.1f * c);
  const float bowl = cone.crater_m / cone.height_m;
  const float bend = c > 0 ? bowl / (c * c) : 0.0f;
  for (std::size_t i = 0; i < r.width; i += hn::Lanes(d)) {
    const V dx = hn::LoadU(d, r.dx + i);
    const V distance = hn::Sqrt(hn::Add(hn::Mul(dx, dx), hn::Mul(dz, dz)));
    const V inverse = hn::Div(hn::Set(d, 1.0f), hn::Max(distance, hn::Set(d, 1e-3f)));
    const Jet<V> away{distance, hn::Mul(dx, inverse), hn::Mul(dz, inverse)};
    const Jet<V> sway{hn::LoadU(d, r.sway + i), hn::LoadU(d, r.sway_x + i), hn::LoadU(d, r.sway_z + i)};
    const Jet<V> t = away * (sway * -0.1f + 1.0f) * (1.0f / cone.radius_m);
    const Jet<V> whole = cone.is_cinder ? heap(t) : flank(t);
    const Jet<V> cut = c > 0 ? lower(whole, t * t * bend + (rim - bowl)) : whole;
    const Jet<V> shape = cone.flat < 1 ? lower(cut, t * (-0.05f * cone.flat) + cone.flat) : cut;
    const Jet<V> rise = shape * cone.height_m;

    const auto higher = hn::Gt(rise.v, hn::LoadU(d, r.rise + i));
    const auto keep = [&](V value, float* array) {
      hn::StoreU(hn::IfThenElse(higher, value, hn::LoadU(d, array + i)), d, array + i);
    };
    keep(rise.x, r.rise_x);
    keep(rise.z, r.rise_z);
    keep(rise.v, r.rise);
    if (cone.is_cinder) continue;
    const V calm = hn::Sub(hn::Set(d, 1.0f), smoothstep(1.0f, kConeCalm, Jet<V>{t.v, zero, zero}).v);
    hn::StoreU(hn::Max(hn::LoadU(d, r.calm + i), calm), d, r.calm + i);
    hn::StoreU(hn::Max(hn::LoadU(d, r.shape + i), shape.v), d, r.shape + i);
    const V worn = smoothstep(0.0f, 0.45f, Jet<V>{shape.v, zero, zero}).v;
    hn::StoreU(hn::Max(hn::LoadU(d, r.gullies + i), hn::Mul(worn, hn::Set(d, cone.gullies))), d, r.gullies + i);
    if (c > 0) {
      const V inside = hn::Sub(hn::Set(d, 1.0f), smoothstep(0.85f * c, 1.15f * c, Jet<V>{t.v, zero, zero}).v);
      hn::StoreU(hn::Max(hn::LoadU(d, r.bowl + i), inside), d, r.bowl + i);
    }
  }
}

void cone_sum_row(const ConeSumRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const auto add = [&](const float* rise, float* to) {
      hn::StoreU(hn::Add(hn::LoadU(d, to + i), hn::LoadU(d, rise + i)), d, to + i);
    };
    add(r.rise, r.height);
    add(r.rise_x, r.slope_x);
    add(r.rise_z, r.slope_z);
  }
}

void cone_erosion_row(const ConeErosionRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const auto rising = [&](V v, float low, float high) { return smoothstep(low, high, Jet<V>{v, v, v}).v; };
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    // Summits count as peaks. Where a foot meets the ground the slope turns, which the filter would take for a valley's
    // floor and dig a moat: there is neither peak nor valley. Under water nothing is worn.
    const V target = hn::Mul(rising(hn::LoadU(d, r.shape + i), 0.1f, 1.0f), hn::Set(d, 1.1f));
    hn::StoreU(mix(hn::LoadU(d, r.fade + i), target, hn::LoadU(d, r.calm + i)), d, r.fade + i);
    const V gullies = hn::LoadU(d, r.gullies + i);
    const V wear = hn::Mul(gullies, rising(hn::LoadU(d, r.height + i), -120.0f, -10.0f));
    // Nothing runs out of a crater, and gullies that meet in its middle would cut it like a cake.
    const V open = hn::Sub(hn::Set(d, 1.0f), hn::LoadU(d, r.bowl + i));
    hn::StoreU(hn::Mul(hn::Max(hn::LoadU(d, r.strength + i), wear), open), d, r.strength + i);
    hn::StoreU(hn::Max(hn::LoadU(d, r.hilliness + i), gullies), d, r.hilliness + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(cone_row);
HWY_EXPORT(cone_sum_row);
HWY_EXPORT(cone_erosion_row);

namespace {

enum ConeArray : std::size_t { kRise, kRiseX, kRiseZ, kCalm, kShape, kGullies, kBowl, kSway, kSwayX, kSwayZ, kArrays };
static_assert(kConeArrays == kArrays);

/// Samples of an axis within `reach_m` of `centre_m`.
struct Reached {
  std::size_t first = 0;
  std::size_t count = 0;
};
Reached reached(std::int64_t start_voxel, std::int64_t step_voxel, double voxel_m, int count, double centre_m,
                double reach_m) {
  const double step_m = static_cast<double>(step_voxel) * voxel_m;
  const double start_m = static_cast<double>(start_voxel) * voxel_m;
  const double low = std::ceil((centre_m - reach_m - start_m) / step_m);
  const double high = std::floor((centre_m + reach_m - start_m) / step_m);
  const double last = count - 1;
  if (high < 0 || low > last || low > high) return {};
  const auto first = static_cast<std::size_t>(std::max(low, 0.0));
  return {first, static_cast<std::size_t>(std::min(high, last)) - first + 1};
}

/// The workspace as arrays over the grid.
struct ConeArrays {
  std::span<float> memory;
  std::size_t count;
  float* at(ConeArray array, std::size_t column) const { return &memory[array * count + column]; }
  std::span<float> whole(ConeArray array) const { return memory.subspan(array * count, count); }
};

bool any_of_kind(std::span<const Cone> cones, bool is_cinder) {
  return std::ranges::any_of(cones, [&](const Cone& cone) { return cone.is_cinder == is_cinder; });
}

/// Fills the arrays with the cones of one kind.
void gather_rise(const ConeControls& c, std::span<const Cone> cones, bool is_cinder, const ColumnGrid& grid,
                 const ConeArrays& arrays) {
  TALUS_CHECK(grid.width >= 1 && grid.width <= kColumnsMax && grid.depth >= 1 && grid.depth <= kColumnsMax);
  TALUS_CHECK(arrays.memory.size() >= kConeArrays * arrays.count);
  std::ranges::fill(arrays.memory.first(kSway * arrays.count), 0.0f);
  fractal_noise({900, 2, 2, 0.5, mix64(c.seed, 1)}, grid, arrays.whole(kSway), arrays.whole(kSwayX),
                arrays.whole(kSwayZ));
  alignas(64) std::array<float, kColumnsMax> dx;
  const auto raise = HWY_DYNAMIC_DISPATCH(cone_row);
  for (const Cone& cone : cones) {
    if (cone.is_cinder != is_cinder) continue;
    const double reach_m = kConeReach * static_cast<double>(cone.radius_m);
    const Reached x = reached(grid.x_voxel, grid.step_voxel, grid.voxel_m, grid.width, cone.x_m, reach_m);
    const Reached z = reached(grid.z_voxel, grid.step_voxel, grid.voxel_m, grid.depth, cone.z_m, reach_m);
    if (x.count == 0 || z.count == 0) continue;
    const auto from = [&](std::int64_t start, std::size_t n, double centre_m) {
      const std::int64_t voxel = start + static_cast<std::int64_t>(n) * grid.step_voxel;
      return static_cast<float>(static_cast<double>(voxel) * grid.voxel_m - centre_m);
    };
    // Whole vectors: the columns before and after are out of reach, where the shape is 0.
    const std::size_t first = x.first / kRowPadding * kRowPadding;
    const std::size_t width = (x.first + x.count - first + kRowPadding - 1) / kRowPadding * kRowPadding;
    for (std::size_t i = 0; i < width; ++i) dx[i] = from(grid.x_voxel, first + i, cone.x_m);
    for (std::size_t k = z.first; k < z.first + z.count; ++k) {
      const std::size_t at = k * row_stride(grid) + first;
      raise(cone, {dx.data(), from(grid.z_voxel, k, cone.z_m), arrays.at(kSway, at), arrays.at(kSwayX, at),
                   arrays.at(kSwayZ, at), arrays.at(kRise, at), arrays.at(kRiseX, at), arrays.at(kRiseZ, at),
                   arrays.at(kCalm, at), arrays.at(kShape, at), arrays.at(kGullies, at), arrays.at(kBowl, at), width});
    }
  }
}

void add_rise(const ColumnGrid& grid, const ConeArrays& arrays, const ConeSurface& surface) {
  TALUS_CHECK(surface.height_m.size() >= arrays.count && surface.slope_x.size() >= arrays.count);
  TALUS_CHECK(surface.slope_z.size() >= arrays.count);
  for (std::size_t at = 0; at < arrays.count; at += row_stride(grid)) {
    HWY_DYNAMIC_DISPATCH(cone_sum_row)
    ({arrays.at(kRise, at), arrays.at(kRiseX, at), arrays.at(kRiseZ, at), &surface.height_m[at], &surface.slope_x[at],
      &surface.slope_z[at]},
     static_cast<std::size_t>(grid.width));
  }
}

}  // namespace

void raise_cones(const ConeControls& c, std::span<const Cone> cones, const ColumnGrid& grid, const ConeSurface& relief,
                 const ConeErosion& erosion, std::span<float> workspace) {
  if (!any_of_kind(cones, false)) return;
  const ConeArrays arrays{workspace, sample_count(grid)};
  gather_rise(c, cones, false, grid, arrays);
  add_rise(grid, arrays, relief);
  TALUS_CHECK(erosion.fade_target.size() >= arrays.count && erosion.strength.size() >= arrays.count);
  TALUS_CHECK(erosion.hilliness.size() >= arrays.count);
  for (std::size_t at = 0; at < arrays.count; at += row_stride(grid)) {
    HWY_DYNAMIC_DISPATCH(cone_erosion_row)
    ({&relief.height_m[at], arrays.at(kCalm, at), arrays.at(kShape, at), arrays.at(kGullies, at), arrays.at(kBowl, at),
      &erosion.fade_target[at], &erosion.strength[at], &erosion.hilliness[at]},
     static_cast<std::size_t>(grid.width));
  }
}

void heap_cinders(const ConeControls& c, std::span<const Cone> cones, const ColumnGrid& grid,
                  const ConeSurface& surface, std::span<float> workspace) {
  if (!any_of_kind(cones, true)) return;
  const ConeArrays arrays{workspace, sample_count(grid)};
  gather_rise(c, cones, true, grid, arrays);
  add_rise(grid, arrays, surface);
}

}  // namespace talus
#endif  // HWY_ONCE
