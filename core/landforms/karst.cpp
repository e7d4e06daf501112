#include "core/landforms/karst.hpp"

#include <array>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/grid/axis.hpp"
#include "core/noise/gradient_noise.hpp"

#ifndef TALUS_KARST_ROW
#define TALUS_KARST_ROW
namespace talus {

struct KarstTerms {
  float height_m, sink_m, cell_m;
  std::uint32_t towers, sinks;  ///< hashes of 16 bits below the first are towers, from there to the second sinkholes
};

struct KarstRow {
  const Axis* x;
  const Axis* z;
  std::size_t k;
  std::array<const float*, 3> weight;
  std::array<const float*, 3> rough;  ///< noise that frays outlines, slopes per metre
  std::array<float*, 3> ground;
};

/// Share of cells that hold a sinkhole.
inline constexpr double kSinkShare = 0.2;
/// Reach of a tower and of a sinkhole, in cells; less than the 1.5 that four taps cover.
inline constexpr float kTowerReach = 0.85f;
inline constexpr float kSinkReach = 0.55f;

}  // namespace talus
#endif  // TALUS_KARST_ROW

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/landforms/karst.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sums over the points near a vector of columns; slopes per cell.
template <class V>
struct KarstSums {
  Jet<V> tower;   ///< bumps of towers
  Jet<V> height;  ///< the same times each tower's height, 0.4..1
  Jet<V> sink;
};

/// (1 - |v|^2 / reach^2)^2 inside the reach, times `by`.
template <class V>
HWY_INLINE Jet<V> bump(V vx, V vz, V r2, float reach, V by) {
  const hn::DFromV<V> d;
  const V inside = hn::Max(hn::Sub(hn::Set(d, 1.0f), hn::Mul(r2, hn::Set(d, 1.0f / (reach * reach)))), hn::Zero(d));
  const V slope = hn::Mul(hn::Mul(inside, by), hn::Set(d, -4.0f / (reach * reach)));
  return {hn::Mul(hn::Mul(inside, inside), by), hn::Mul(slope, vx), hn::Mul(slope, vz)};
}

template <class D, class V = VecOf<D>>
HWY_INLINE KarstSums<V> gather_points(D d, const KarstTerms& t, const KarstRow& r, std::size_t i) {
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
  const Jet<V> none{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  KarstSums<V> sums{none, none, none};
  const V fx = hn::LoadU(d, &r.x->fraction[i]);
  const V fz = hn::Set(d, r.z->fraction[r.k]);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto hash_z = hn::Set(du, r.z->cell_hash[k][r.k]);
    const V rz = hn::Sub(fz, hn::Set(d, static_cast<float>(k) - 1.0f));
    for (std::size_t j = 0; j < 4; ++j) {
      auto h = hn::Xor(hn::LoadU(du, &r.x->cell_hash[j][i]), hash_z);
      h = hn::Mul(hn::Xor(h, hn::ShiftRight<16>(h)), hn::Set(du, 0x85EBCA6BU));
      h = hn::Mul(hn::Xor(h, hn::ShiftRight<13>(h)), hn::Set(du, 0xC2B2AE35U));
      const auto bits = hn::BitCast(di, h);
      const V to_cells = hn::Set(d, 0x1p-16f);
      const V jitter_x = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(bits))), to_cells);
      const V jitter_z = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(bits)), to_cells);
      const V vx = hn::Sub(hn::Sub(fx, hn::Set(d, static_cast<float>(j) - 1.0f)), jitter_x);
      const V vz = hn::Sub(rz, jitter_z);
      const V r2 = hn::Add(hn::Mul(vx, vx), hn::Mul(vz, vz));
      if (hn::AllFalse(d, hn::Lt(r2, hn::Set(d, kTowerReach * kTowerReach)))) continue;
      // A second word of chance: what the point is, and how high.
      auto more = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(du, 0x9E3779B1U));
      more = hn::Xor(more, hn::ShiftRight<14>(more));
      const auto kind = hn::BitCast(di, hn::And(more, hn::Set(du, 0xFFFFU)));
      const auto is_tower = hn::Lt(kind, hn::Set(di, static_cast<std::int32_t>(t.towers)));
      const auto is_sink = hn::AndNot(is_tower, hn::Lt(kind, hn::Set(di, static_cast<std::int32_t>(t.sinks))));
      const V one = hn::Set(d, 1.0f);
      const V share = hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<16>(more))), to_cells);
      const V tall = hn::Add(hn::Mul(share, hn::Set(d, 0.6f)), hn::Set(d, 0.4f));
      const Jet<V> tower = bump(vx, vz, r2, kTowerReach, hn::IfThenElseZero(hn::RebindMask(d, is_tower), one));
      sums.tower = sums.tower + tower;
      sums.height = sums.height + Jet<V>{hn::Mul(tower.v, tall), hn::Mul(tower.x, tall), hn::Mul(tower.z, tall)};
      sums.sink = sums.sink + bump(vx, vz, r2, kSinkReach, hn::IfThenElseZero(hn::RebindMask(d, is_sink), one));
    }
  }
  return sums;
}

void karst_row(const KarstTerms& t, const KarstRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const Jet<V> w{hn::LoadU(d, r.weight[0] + i), hn::LoadU(d, r.weight[1] + i), hn::LoadU(d, r.weight[2] + i)};
    const auto some = hn::Gt(w.v, hn::Zero(d));
    if (hn::AllFalse(d, some)) continue;
    const KarstSums<V> s = gather_points(d, t, r, i);
    // Mean height of the towers here, then walls where their sum passes a threshold, and a dome on top.
    const V inverse = hn::Div(hn::Set(d, 1.0f), hn::Max(s.tower.v, hn::Set(d, 1e-6f)));
    const V mean = hn::Mul(s.height.v, inverse);
    const Jet<V> tall{mean, hn::Mul(hn::Sub(s.height.x, hn::Mul(mean, s.tower.x)), inverse),
                      hn::Mul(hn::Sub(s.height.z, hn::Mul(mean, s.tower.z)), inverse)};
    const Jet<V> rough{hn::LoadU(d, r.rough[0] + i), hn::Mul(hn::LoadU(d, r.rough[1] + i), hn::Set(d, t.cell_m)),
                       hn::Mul(hn::LoadU(d, r.rough[2] + i), hn::Set(d, t.cell_m))};
    const Jet<V> sum = s.tower + s.tower * rough * 0.55f;
    const Jet<V> wall = smoothstep(0.2f, 0.5f, sum);
    const Jet<V> dome = smoothstep(0.15f, 1.15f, sum);
    const Jet<V> tower = wall * tall * (dome * 0.65f + 0.35f) * t.height_m;
    Jet<V> change = tower - s.sink * t.sink_m;
    const V per_m = hn::Set(d, 1.0f / t.cell_m);
    change.x = hn::Mul(change.x, per_m);
    change.z = hn::Mul(change.z, per_m);
    const Jet<V> added = change * w;
    const auto add = [&](float* to, V by) {
      const V before = hn::LoadU(d, to + i);
      hn::StoreU(hn::IfThenElse(some, hn::Add(before, by), before), d, to + i);
    };
    add(r.ground[0], added.v);
    add(r.ground[1], added.x);
    add(r.ground[2], added.z);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(karst_row);

void karst(const KarstControls& c, const ColumnGrid& grid, const JetArrays& weight, const GroundArrays& ground,
           std::span<float> workspace) {
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(workspace.size() >= kKarstArrays * count);
  fractal_noise({c.cell_m * 0.7, 3, 2.1, 0.5, mix64(c.seed, 1)}, grid, workspace.subspan(0, count),
                workspace.subspan(count, count), workspace.subspan(2 * count, count));
  const Octave octave = octave_on(grid, 1 / c.cell_m, mix64(c.seed, 0));
  Axis x;
  Axis z;
  split_axis(octave, 0, grid.x_voxel, grid.step_voxel, grid.voxel_m, grid.width, -1, 4, x);
  split_axis(octave, 1, grid.z_voxel, grid.step_voxel, grid.voxel_m, grid.depth, -1, 4, z);
  const double sinks = c.share + kSinkShare < 1 ? c.share + kSinkShare : 1;
  const KarstTerms terms{static_cast<float>(c.height_m), static_cast<float>(c.sink_m),
                         static_cast<float>(1 / octave.cells_per_m), static_cast<std::uint32_t>(c.share * 65'536),
                         static_cast<std::uint32_t>(sinks * 65'536)};
  const auto row = HWY_DYNAMIC_DISPATCH(karst_row);
  const std::size_t stride = row_stride(grid);
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.depth); ++k) {
    const std::size_t at = k * stride;
    row(terms,
        {&x,
         &z,
         k,
         {&weight.v[at], &weight.x[at], &weight.z[at]},
         {&workspace[at], &workspace[count + at], &workspace[2 * count + at]},
         {&ground.height_m[at], &ground.slope_x[at], &ground.slope_z[at]}},
        static_cast<std::size_t>(grid.width));
  }
}

glm::dvec2 karst_bound(const KarstControls& c, glm::dvec2 heights_m) {
  // No more than 9 sinkholes reach a point.
  return {heights_m.x - 9 * c.sink_m, heights_m.y + c.height_m};
}

}  // namespace talus
#endif  // HWY_ONCE
