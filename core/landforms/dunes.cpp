#include "core/landforms/dunes.hpp"

#include <array>
#include <numbers>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/grid/axis.hpp"
#include "core/noise/gradient_noise.hpp"

#ifndef TALUS_DUNE_ROW
#define TALUS_DUNE_ROW
namespace talus {

/// Large dunes, and the smaller ones that ride on them.
inline constexpr std::size_t kDuneWaves = 2;
/// Cells per wave: fewer would be grain, more would never fork.
inline constexpr float kDuneCell = 0.7f;
/// Large dunes reach from 0.35 to 1.25 times the height.
inline constexpr float kDuneLow = 0.35f;
inline constexpr float kDuneVary = 0.9f;
/// Size of the small dunes against the large ones, in wavelength and in height.
inline constexpr double kDuneSmall = 0.21;
inline constexpr float kDuneSmallHeight = 0.11f;

struct DuneRow {
  std::array<const Axis*, kDuneWaves> x;
  std::array<const Axis*, kDuneWaves> z;
  std::size_t k;
  std::array<const float*, 3> weight;
  const float *wind, *vary;
  std::array<float*, 3> ground;
};

struct DuneTerms {
  float wind_cycles;  ///< direction of the wind where its noise is 0
  float skew_cycles;  ///< skew / 2 pi
  float skew;
  std::array<float, kDuneWaves> height_m;
  std::array<float, kDuneWaves> radians_per_m;
};

}  // namespace talus
#endif  // TALUS_DUNE_ROW

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/landforms/dunes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/jet-inl.hpp"
#include "core/noise/phacelle-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The profile of one wave over its phase, 0..1, and its slope per radian. q = (1 - cos)/2 + e^2 draws the crest (phase
/// 0) to an edge rounded over e.
template <class D, class V = VecOf<D>>
HWY_INLINE void dune_profile(D d, const DuneTerms& t, V cosine, V sine, V& profile, V& per_radian) {
  const V one = hn::Set(d, 1.0f);
  // phase' = phase + skew (1 - cos phase): one side of each crest is steeper than the other.
  V turn_cos;
  V turn_sin;
  cos_sin_cycles(d, hn::Mul(hn::Sub(one, cosine), hn::Set(d, t.skew_cycles)), turn_cos, turn_sin);
  const V c = hn::Sub(hn::Mul(cosine, turn_cos), hn::Mul(sine, turn_sin));
  const V s = hn::Add(hn::Mul(sine, turn_cos), hn::Mul(cosine, turn_sin));
  const V half = hn::Set(d, 0.5f);
  const V q = hn::Add(hn::Mul(hn::Sub(one, c), half), hn::Set(d, 0.012f));
  const V root = hn::Sqrt(q);
  profile = hn::Sub(one, root);
  const V phase_slope = hn::Add(one, hn::Mul(sine, hn::Set(d, t.skew)));
  per_radian = hn::Mul(hn::Div(hn::Mul(s, hn::Set(d, -0.25f)), root), phase_slope);
}

void dune_row(const DuneTerms& t, const DuneRow& r, std::size_t width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  std::array<PhacelleRow, kDuneWaves> rows;
  for (std::size_t n = 0; n < kDuneWaves; ++n) {
    rows[n].x = r.x[n];
    rows[n].fraction_z = r.z[n]->fraction[r.k];
    for (std::size_t tap = 0; tap < 4; ++tap) rows[n].hash_z[tap] = r.z[n]->cell_hash[tap][r.k];
  }
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const V weight = hn::LoadU(d, r.weight[0] + i);
    const auto some = hn::Gt(weight, hn::Zero(d));
    if (hn::AllFalse(d, some)) continue;
    // Crests run along (nx, nz), the wind across them along (-nz, nx).
    V nx;
    V nz;
    cos_sin_cycles(d, hn::Add(hn::Mul(hn::LoadU(d, r.wind + i), hn::Set(d, 0.22f)), hn::Set(d, t.wind_cycles)), nx, nz);
    const V varied = smoothstep(-0.35f, 0.4f, Jet<V>{hn::LoadU(d, r.vary + i), hn::Zero(d), hn::Zero(d)}).v;
    const V size = hn::Add(hn::Mul(varied, hn::Set(d, kDuneVary)), hn::Set(d, kDuneLow));
    V height = hn::Zero(d);
    V along_wind = hn::Zero(d);
    for (std::size_t n = 0; n < kDuneWaves; ++n) {
      V cosine;
      V sine;
      phacelle(d, rows[n], i, nx, nz, hn::Set(d, kDuneCell), hn::Zero(d), hn::Set(d, 0.5f), cosine, sine);
      V profile;
      V per_radian;
      dune_profile(d, t, cosine, sine, profile, per_radian);
      const V scale = hn::Mul(size, hn::Set(d, t.height_m[n]));
      height = hn::Add(height, hn::Mul(profile, scale));
      along_wind = hn::Add(along_wind, hn::Mul(hn::Mul(per_radian, scale), hn::Set(d, t.radians_per_m[n])));
    }
    const V slope = hn::Mul(along_wind, weight);
    const auto add = [&](std::size_t axis, V change) {
      const V before = hn::LoadU(d, r.ground[axis] + i);
      hn::StoreU(hn::IfThenElse(some, hn::Add(before, change), before), d, r.ground[axis] + i);
    };
    add(0, hn::Mul(height, weight));
    add(1, hn::Add(hn::Mul(height, hn::LoadU(d, r.weight[1] + i)), hn::Neg(hn::Mul(slope, nz))));
    add(2, hn::Add(hn::Mul(height, hn::LoadU(d, r.weight[2] + i)), hn::Mul(slope, nx)));
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(dune_row);

void dunes(const DuneControls& c, const ColumnGrid& grid, const JetArrays& weight, const GroundArrays& ground,
           std::span<float> workspace) {
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(workspace.size() >= kDuneArrays * count);
  const auto array = [&](std::size_t n) { return workspace.subspan(n * count, count); };
  fractal_noise({c.wind_m, 1, 2, 0.5, mix64(c.seed, 0)}, grid, array(0), array(1), array(2));
  fractal_noise({c.wavelength_m * 5, 2, 2, 0.5, mix64(c.seed, 1)}, grid, array(3), array(4), array(5));

  DuneTerms terms{};
  terms.wind_cycles = static_cast<float>(mix64(c.seed, 2) >> 40) * 0x1p-24f;
  terms.skew = static_cast<float>(c.skew);
  terms.skew_cycles = static_cast<float>(c.skew / (2 * std::numbers::pi));
  std::array<Axis, kDuneWaves> x;
  std::array<Axis, kDuneWaves> z;
  double wave_m = c.wavelength_m;
  double height_m = c.height_m;
  for (std::size_t n = 0; n < kDuneWaves; ++n) {
    const Octave octave = octave_on(grid, 1 / (wave_m * static_cast<double>(kDuneCell)), mix64(c.seed, 3 + n));
    split_axis(octave, 0, grid.x_voxel, grid.step_voxel, grid.voxel_m, grid.width, -1, 4, x[n]);
    split_axis(octave, 1, grid.z_voxel, grid.step_voxel, grid.voxel_m, grid.depth, -1, 4, z[n]);
    terms.height_m[n] = static_cast<float>(height_m);
    terms.radians_per_m[n] =
        static_cast<float>(2 * std::numbers::pi * static_cast<double>(kDuneCell) * octave.cells_per_m);
    wave_m *= kDuneSmall;
    height_m *= static_cast<double>(kDuneSmallHeight);
  }
  const auto row = HWY_DYNAMIC_DISPATCH(dune_row);
  const std::size_t stride = row_stride(grid);
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.depth); ++k) {
    const std::size_t at = k * stride;
    row(terms,
        {{&x[0], &x[1]},
         {&z[0], &z[1]},
         k,
         {&weight.v[at], &weight.x[at], &weight.z[at]},
         &workspace[at],
         &workspace[3 * count + at],
         {&ground.height_m[at], &ground.slope_x[at], &ground.slope_z[at]}},
        static_cast<std::size_t>(grid.width));
  }
}

glm::dvec2 dunes_bound(const DuneControls& c, glm::dvec2 heights_m) {
  // A profile lies between 1 - sqrt(1.012) and 1.
  const double most = c.height_m * static_cast<double>((kDuneLow + kDuneVary) * (1 + kDuneSmallHeight));
  return {heights_m.x - 0.01 * most, heights_m.y + most};
}

}  // namespace talus
#endif  // HWY_ONCE
