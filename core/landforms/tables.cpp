#include "core/landforms/tables.hpp"

#include <array>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/noise/gradient_noise.hpp"

#ifndef TALUS_TABLES_ROW
#define TALUS_TABLES_ROW
namespace talus {

struct TablesRow {
  std::array<const float*, 3> weight, first, second;  ///< value and slopes
  std::array<float*, 3> ground;
  std::array<float*, 3> rills;  ///< fade target and slopes of finer erosion
};

}  // namespace talus
#endif  // TALUS_TABLES_ROW

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/landforms/tables.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = VecOf<D>, class P>
HWY_INLINE Jet<V> load(D d, const std::array<P, 3>& a, std::size_t i) {
  return {hn::LoadU(d, a[0] + i), hn::LoadU(d, a[1] + i), hn::LoadU(d, a[2] + i)};
}

/// Lanes without weight keep their bits.
template <class D, class V = VecOf<D>>
HWY_INLINE void store_where(D d, hn::Mask<D> some, const Jet<V>& before, const Jet<V>& after,
                            const std::array<float*, 3>& to, std::size_t i) {
  hn::StoreU(hn::IfThenElse(some, after.v, before.v), d, to[0] + i);
  hn::StoreU(hn::IfThenElse(some, after.x, before.x), d, to[1] + i);
  hn::StoreU(hn::IfThenElse(some, after.z, before.z), d, to[2] + i);
}

void badlands_row(float hill_m, const TablesRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const Jet<V> w = load(d, r.weight, i);
    const auto some = hn::Gt(w.v, hn::Zero(d));
    if (hn::AllFalse(d, some)) continue;
    const Jet<V> n = load(d, r.first, i);
    const Jet<V> before = load(d, r.ground, i);
    // Basins fill with wash: what lies under -0.2 is half as deep.
    const Jet<V> filled = n * (smoothstep(-0.5f, 0.05f, n) * 0.6f + 0.4f);
    store_where(d, some, before, before + w * filled * hill_m, r.ground, i);
    const V fade = hn::LoadU(d, r.rills[0] + i);
    const V own = hn::Mul(n.v, hn::Set(d, 2.4f));
    hn::StoreU(hn::IfThenElse(some, mix(fade, own, w.v), fade), d, r.rills[0] + i);
    const V under = hn::Set(d, 0.25f);
    const V hill = hn::Set(d, hill_m);
    hn::StoreU(hn::Add(hn::Mul(filled.x, hill), hn::Mul(before.x, under)), d, r.rills[1] + i);
    hn::StoreU(hn::Add(hn::Mul(filled.z, hill), hn::Mul(before.z, under)), d, r.rills[2] + i);
  }
}

void mesas_row(float height_m, float canyon_width, const TablesRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const Jet<V> w = load(d, r.weight, i);
    const auto some = hn::Gt(w.v, hn::Zero(d));
    if (hn::AllFalse(d, some)) continue;
    const Jet<V> table = load(d, r.first, i);
    const Jet<V> line = load(d, r.second, i);
    const Jet<V> before = load(d, r.ground, i);
    // Two steps of land, and canyons along the zero lines of a second noise, flat at their floor so that the kink of
    // its absolute value lies where nothing depends on it.
    const Jet<V> lift = smoothstep(-0.34f, 0.02f, table) * 0.55f + smoothstep(0.06f, 0.36f, table) * 0.45f;
    const Jet<V> across = chained(line, hn::Abs(line.v), hn::CopySign(hn::Set(d, 1.0f), line.v));
    const Jet<V> rim = smoothstep(0.18f * canyon_width, canyon_width, across) * 0.9f + 0.1f;
    store_where(d, some, before, before + w * lift * rim * height_m, r.ground, i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(badlands_row);
HWY_EXPORT(mesas_row);

namespace {

FractalNoise hills_of(const BadlandsControls& c) {
  return {c.wavelength_m, 3, 2.1, 0.3, c.seed};
}

TablesRow row_at(std::size_t at, const JetArrays& weight, const GroundArrays& g, std::span<float> first,
                 std::span<float> second, std::size_t count) {
  const auto jet = [&](std::span<float> a) {
    return std::array<const float*, 3>{&a[at], &a[count + at], &a[2 * count + at]};
  };
  return {{&weight.v[at], &weight.x[at], &weight.z[at]},
          jet(first),
          jet(second),
          {&g.height_m[at], &g.slope_x[at], &g.slope_z[at]},
          {}};
}

void sample(const FractalNoise& noise, const ColumnGrid& grid, std::span<float> out) {
  const std::size_t count = sample_count(grid);
  fractal_noise(noise, grid, out.subspan(0, count), out.subspan(count, count), out.subspan(2 * count, count));
}

}  // namespace

void badlands(const BadlandsControls& c, const ColumnGrid& grid, const JetArrays& weight, const GroundArrays& ground,
              const JetArrays& rills, std::span<float> workspace) {
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(workspace.size() >= kBadlandsArrays * count && rills.v.size() >= count);
  sample(hills_of(c), grid, workspace);
  const auto row = HWY_DYNAMIC_DISPATCH(badlands_row);
  for (std::size_t at = 0; at < count; at += row_stride(grid)) {
    TablesRow r = row_at(at, weight, ground, workspace, workspace, count);
    r.rills = {&rills.v[at], &rills.x[at], &rills.z[at]};
    row(static_cast<float>(c.hill_m), r, static_cast<std::size_t>(grid.width));
  }
}

void mesas(const MesaControls& c, const ColumnGrid& grid, const JetArrays& weight, const GroundArrays& ground,
           std::span<float> workspace) {
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(workspace.size() >= kMesaArrays * count);
  const auto first = workspace.subspan(0, 3 * count);
  const auto second = workspace.subspan(3 * count, 3 * count);
  sample({c.wavelength_m, 5, 2.1, 0.46, mix64(c.seed, 0)}, grid, first);
  sample({c.wavelength_m * 1.4, 5, 2.1, 0.44, mix64(c.seed, 1)}, grid, second);
  const auto row = HWY_DYNAMIC_DISPATCH(mesas_row);
  for (std::size_t at = 0; at < count; at += row_stride(grid)) {
    row(static_cast<float>(c.height_m), static_cast<float>(c.canyon_width),
        row_at(at, weight, ground, first, second, count), static_cast<std::size_t>(grid.width));
  }
}

glm::dvec2 badlands_bound(const BadlandsControls& c, glm::dvec2 heights_m) {
  const double hills = c.hill_m * noise_bound(hills_of(c));
  // Basins are at most 0.4 as deep as hills are high.
  return {heights_m.x - hills, heights_m.y + hills};
}

glm::dvec2 mesas_bound(const MesaControls& c, glm::dvec2 heights_m) {
  return {heights_m.x, heights_m.y + c.height_m};
}

}  // namespace talus
#endif  // HWY_ONCE
