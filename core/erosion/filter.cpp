#include "core/erosion/filter.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/erosion/terms.hpp"
#include "core/grid/axis.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/erosion/filter.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

#include "core/base/simd_math-inl.hpp"
#include "core/erosion/frequency-inl.hpp"
#include "core/noise/phacelle-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What one octave hands to the next, for one vector of points.
template <class V>
struct ErosionState {
  V gully_x, gully_z;          ///< slope that the next stripes run down; straight gullies, never faded
  V fade, mask;                ///< stacked fading: target and how little of it shows
  V ridge_target, ridge_mask;  ///< the same for the ridge map: no gully weight, no rounding
  V height, slope_x, slope_z;  ///< sums so far
  V magnitude;
  V cut, cut_x, cut_z;  ///< by fine gullies
};

template <class D, class V = VecOf<D>>
HWY_INLINE ErosionState<V> before_octaves(D d, const ErosionTerms& t, V gx, V gz, V fade_target) {
  const V one = hn::Set(d, 1.0f);
  const V fade = hn::Min(hn::Max(fade_target, hn::Set(d, -1.0f)), one);
  const V steepness = hn::Sqrt(hn::Add(hn::Mul(gx, gx), hn::Mul(gz, gz)));
  const V rounding = hn::Mul(
      mix(hn::Set(d, t.rounding_crease), hn::Set(d, t.rounding_ridge), saturate(hn::Add(fade, hn::Set(d, 0.5f)))),
      hn::Set(d, t.rounding_input));
  const V onset = hn::Set(d, t.onset_input);
  ErosionState<V> s;
  s.mask = ease_out(d, smooth_start(d, hn::Mul(steepness, onset), hn::Mul(rounding, onset)));
  const V assumed = hn::Div(hn::Set(d, t.assumed_slope), hn::Max(steepness, hn::Set(d, 1e-10f)));
  const V blend = hn::Set(d, t.assumed_blend);
  s.gully_x = mix(gx, hn::Mul(gx, assumed), blend);
  s.gully_z = mix(gz, hn::Mul(gz, assumed), blend);
  s.fade = fade;
  s.ridge_target = fade;
  s.ridge_mask = ease_out(d, hn::Mul(steepness, hn::Set(d, t.ridge_onset_input)));
  s.height = s.slope_x = s.slope_z = s.magnitude = hn::Zero(d);
  s.cut = s.cut_x = s.cut_z = hn::Zero(d);
  return s;
}

template <class D, class V = VecOf<D>>
HWY_INLINE void add_gullies(D d, const ErosionTerms& t, const ErosionOctave& octave, const PhacelleRow& row,
                            std::size_t i, V point_strength, ErosionState<V>& s) {
  const V steepness = hn::Sqrt(hn::Add(hn::Mul(s.gully_x, s.gully_x), hn::Mul(s.gully_z, s.gully_z)));
  const V inverse = hn::Div(hn::Set(d, 1.0f), hn::Max(steepness, hn::Set(d, 1e-10f)));
  const V nx = hn::Mul(s.gully_x, inverse);
  const V nz = hn::Mul(s.gully_z, inverse);
  V cosine;
  V sine;
  phacelle(d, row, i, nx, nz, hn::Set(d, t.cell_scale), hn::Set(d, 0.25f), hn::Set(d, t.shortest), cosine, sine);

  const V strength = hn::Mul(point_strength, hn::Set(d, octave.strength_m));
  const V weight = hn::Set(d, t.gully_weight);
  // The height cos(angle) falls by sin(angle) along perp(n) = (-nz, nx).
  const V side = hn::Mul(hn::Mul(strength, weight), hn::Set(d, octave.side_slope_per_m));
  const V side_x = hn::Mul(nz, side);
  const V side_z = hn::Neg(hn::Mul(nx, side));

  const V faded = mix(s.fade, hn::Mul(cosine, weight), s.mask);
  s.height = hn::Add(s.height, hn::Mul(faded, strength));
  const V shown = hn::Mul(s.mask, sine);
  const V shown_x = hn::Mul(shown, side_x);
  const V shown_z = hn::Mul(shown, side_z);
  s.slope_x = hn::Add(s.slope_x, shown_x);
  s.slope_z = hn::Add(s.slope_z, shown_z);
  const V fine = hn::Set(d, octave.fine);
  const V below = hn::Mul(hn::Mul(s.mask, weight), hn::Sub(hn::Set(d, 1.0f), cosine));
  s.cut = hn::Add(s.cut, hn::Mul(hn::Mul(strength, fine), below));
  s.cut_x = hn::Sub(s.cut_x, hn::Mul(shown_x, fine));
  s.cut_z = hn::Sub(s.cut_z, hn::Mul(shown_z, fine));
  s.magnitude = hn::Add(s.magnitude, strength);
  s.fade = faded;

  // Straight gullies: the sign of the sine, not the sine, so that branches leave at an angle instead of curling.
  s.gully_x = hn::Add(s.gully_x, hn::CopySign(side_x, hn::Xor(side_x, sine)));
  s.gully_z = hn::Add(s.gully_z, hn::CopySign(side_z, hn::Xor(side_z, sine)));

  const V steep = hn::Abs(sine);
  const V onset = hn::Set(d, t.onset_octave);
  const V rounding = hn::Mul(
      mix(hn::Set(d, t.rounding_crease), hn::Set(d, t.rounding_ridge), saturate(hn::Add(cosine, hn::Set(d, 0.5f)))),
      hn::Set(d, octave.rounding));
  const V fresh = ease_out(d, smooth_start(d, hn::Mul(steep, onset), hn::Mul(rounding, onset)));
  const V one = hn::Set(d, 1.0f);
  const V kept = hn::Sub(one, pow_unit(d, hn::Sub(one, saturate(s.mask)), hn::Set(d, t.detail)));
  s.mask = hn::Mul(kept, fresh);
  s.ridge_target = mix(s.ridge_target, cosine, s.ridge_mask);
  s.ridge_mask = hn::Mul(s.ridge_mask, ease_out(d, hn::Mul(steep, hn::Set(d, t.ridge_onset_octave))));
}

/// The fade method at lanes i.. of a row.
template <class D, class V = VecOf<D>>
HWY_INLINE ErosionResult<V> fade_method(D d, const ErosionTerms& t, const PhacelleRow* rows, std::size_t i, V gx, V gz,
                                        V fade_target, V strength) {
  auto s = before_octaves(d, t, gx, gz, fade_target);
  for (std::size_t o = 0; o < static_cast<std::size_t>(t.octaves); ++o) {
    add_gullies(d, t, t.octave[o], rows[o], i, strength, s);
  }
  return {hn::Add(s.height, hn::Mul(hn::Set(d, t.offset), s.magnitude)),
          s.slope_x,
          s.slope_z,
          hn::Mul(s.ridge_target, hn::Sub(hn::Set(d, 1.0f), s.ridge_mask)),
          s.cut,
          s.cut_x,
          s.cut_z};
}

/// Both methods by their shares. A lane's value is chosen by its own share and strength, so what its neighbours in the
/// vector make necessary to compute changes no bit of it.
void erode_row(const ErosionTerms& t, const ErosionRow& r) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  std::array<PhacelleRow, kErosionOctavesMax> rows;
  for (std::size_t o = 0; o < static_cast<std::size_t>(t.octaves); ++o) {
    const Axis& z = (*r.z)[o];
    rows[o].x = &(*r.x)[o];
    rows[o].fraction_z = z.fraction[r.k];
    for (std::size_t tap = 0; tap < 4; ++tap) rows[o].hash_z[tap] = z.cell_hash[tap][r.k];
  }
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  for (std::size_t i = 0; i < r.width; i += hn::Lanes(d)) {
    const V gx = hn::LoadU(d, r.in_slope_x + i);
    const V gz = hn::LoadU(d, r.in_slope_z + i);
    const V fade = hn::LoadU(d, r.in_fade + i);
    const V strength = hn::LoadU(d, r.in_strength + i);
    const V share = r.in_frequency == nullptr ? zero : hn::LoadU(d, r.in_frequency + i);
    const auto worn = hn::Gt(strength, zero);
    const auto some_frequency = hn::And(worn, hn::Gt(share, zero));
    const auto some_fade = hn::And(worn, hn::Lt(share, one));
    ErosionResult<V> out{zero, zero, zero, zero, zero, zero, zero};
    if (!hn::AllFalse(d, some_fade)) out = fade_method(d, t, rows.data(), i, gx, gz, fade, strength);
    if (!hn::AllFalse(d, some_frequency)) {
      const auto other = frequency_method(d, t, rows.data(), i, gx, gz, fade, strength);
      const auto blend = [&](V a, V b) {
        const V both = hn::IfThenElse(some_fade, mix(a, b, share), b);
        return hn::IfThenElse(some_frequency, both, a);
      };
      out = {blend(out.height, other.height), blend(out.slope_x, other.slope_x), blend(out.slope_z, other.slope_z),
             blend(out.ridge, other.ridge),   blend(out.cut, other.cut),         blend(out.cut_x, other.cut_x),
             blend(out.cut_z, other.cut_z)};
    }
    hn::StoreU(hn::IfThenElseZero(worn, out.height), d, r.height + i);
    hn::StoreU(hn::IfThenElseZero(worn, out.slope_x), d, r.slope_x + i);
    hn::StoreU(hn::IfThenElseZero(worn, out.slope_z), d, r.slope_z + i);
    hn::StoreU(hn::IfThenElseZero(worn, out.ridge), d, r.ridge + i);
    if (r.cut == nullptr) continue;
    hn::StoreU(hn::IfThenElseZero(worn, out.cut), d, r.cut + i);
    hn::StoreU(hn::IfThenElseZero(worn, out.cut_x), d, r.cut_x + i);
    hn::StoreU(hn::IfThenElseZero(worn, out.cut_z), d, r.cut_z + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(erode_row);

namespace {

ErosionTerms terms_of(const ErosionControls& c, const std::array<Octave, kErosionOctavesMax>& octaves) {
  const auto f = [](double v) { return static_cast<float>(v); };
  ErosionTerms t{};
  t.octaves = c.octaves;
  double strength_m = c.strength * c.scale_m;
  double rounding = 1;
  double width_m = c.scale_m;
  for (std::size_t o = 0; o < static_cast<std::size_t>(c.octaves); ++o) {
    const double fine = std::clamp((kFineNone_m - width_m) / (kFineNone_m - kFineFull_m), 0.0, 1.0);
    t.octave[o] = {f(strength_m), f(2 * std::numbers::pi * c.cell_scale * octaves[o].cells_per_m), f(rounding),
                   f(fine)};
    width_m /= c.lacunarity;
    strength_m *= c.gain;
    rounding *= c.rounding_octave;
  }
  t.gully_weight = f(c.gully_weight);
  t.detail = f(c.detail);
  t.rounding_ridge = f(c.rounding_ridge);
  t.rounding_crease = f(c.rounding_crease);
  t.rounding_input = f(c.rounding_input);
  t.onset_input = f(c.onset_input);
  t.onset_octave = f(c.onset_octave);
  t.ridge_onset_input = f(c.ridge_onset_input);
  t.ridge_onset_octave = f(c.ridge_onset_octave);
  t.assumed_slope = f(c.assumed_slope);
  t.assumed_blend = f(c.assumed_blend);
  t.cell_scale = f(c.cell_scale);
  t.shortest = f(1 - c.normalisation);
  t.offset = f(c.offset);
  t.frequency_slope = f(c.frequency_slope);
  t.frequency_max = f(c.frequency_max);
  t.frequency_branch = f(c.frequency_branch);
  t.frequency_pull = f(c.frequency_pull);
  t.frequency_valley = f(c.frequency_valley);
  return t;
}

}  // namespace

double erosion_bound(const ErosionControls& c) {
  // |faded| <= 1 in every octave: it mixes a clamped target and a weighted cosine. The frequency method cuts at most 2
  // weights below and pulls by a clamped target.
  double sum = 0;
  double strength_m = c.strength * c.scale_m;
  for (int o = 0; o < c.octaves; ++o) {
    sum += strength_m;
    strength_m *= c.gain;
  }
  const double fade = 1 + (c.offset < 0 ? -c.offset : c.offset);
  const double frequency = 2 * c.gully_weight + c.frequency_pull;
  return sum * (fade > frequency ? fade : frequency);
}

void erode(const ErosionControls& c, const ColumnGrid& grid, const ErosionInput& in, const ErosionOutput& out) {
  TALUS_CHECK(c.octaves >= 0 && c.octaves <= kErosionOctavesMax);
  TALUS_CHECK(grid.width >= 1 && grid.width <= kColumnsMax && grid.depth >= 1 && grid.depth <= kColumnsMax);
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(in.slope_x.size() >= count && in.slope_z.size() >= count && in.fade_target.size() >= count);
  TALUS_CHECK(in.strength.size() >= count && out.height_m.size() >= count && out.slope_x.size() >= count);
  TALUS_CHECK(out.slope_z.size() >= count && out.ridge.size() >= count);

  TALUS_CHECK(in.frequency_share.empty() || in.frequency_share.size() >= count);
  TALUS_CHECK(out.cut_m.empty() || out.cut_m.size() >= count);
  TALUS_CHECK(out.cut_x.size() == out.cut_m.size() && out.cut_z.size() == out.cut_m.size());

  std::array<Octave, kErosionOctavesMax> octaves{};
  std::array<Axis, kErosionOctavesMax> x;
  std::array<Axis, kErosionOctavesMax> z;
  double cells_per_m = 1.0 / (c.scale_m * c.cell_scale);
  for (std::size_t o = 0; o < static_cast<std::size_t>(c.octaves); ++o) {
    octaves[o] = octave_on(grid, cells_per_m, mix64(c.seed, o));
    split_axis(octaves[o], 0, grid.x_voxel, grid.step_voxel, grid.voxel_m, grid.width, -1, 4, x[o]);
    split_axis(octaves[o], 1, grid.z_voxel, grid.step_voxel, grid.voxel_m, grid.depth, -1, 4, z[o]);
    cells_per_m *= c.lacunarity;
  }
  const ErosionTerms terms = terms_of(c, octaves);
  const std::size_t stride = row_stride(grid);
  const auto row = HWY_DYNAMIC_DISPATCH(erode_row);
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.depth); ++k) {
    const std::size_t at = k * stride;
    const auto asked = [at](std::span<float> array) { return array.empty() ? nullptr : &array[at]; };
    row(terms,
        {&x, &z, k, static_cast<std::size_t>(grid.width), &in.slope_x[at], &in.slope_z[at], &in.fade_target[at],
         &in.strength[at], in.frequency_share.empty() ? nullptr : &in.frequency_share[at], &out.height_m[at],
         &out.slope_x[at], &out.slope_z[at], &out.ridge[at], asked(out.cut_m), asked(out.cut_x), asked(out.cut_z)});
  }
}

}  // namespace talus
#endif  // HWY_ONCE
