// The frequency method of the erosion filter: stripes the closer the steeper the ground, none where it is flat.
//
// Problem: where a slope is zero it has no direction, and stripes of one width tear there. Answer: stripes as wide as
// the ground is flat, so that every flat lies on the ridge of one endless stripe; peaks keep their shape and valleys
// stay smooth. Based on: C. John, "Eroded Terrain Noise", 2018; F. Westin, 2023; R. Johansen, "Fast and Gorgeous
// Erosion Filter", 2026 (description). What differs: a soft limit on the frequency, which the noise's cells cannot
// follow without end; gullies that give out towards valley floors; and a pull of peaks and valleys apart, so that
// country of this method meets country of the fade method at like heights. Include inside a file that Highway compiles
// once per target.

#if defined(TALUS_FREQUENCY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_FREQUENCY_INL
#undef TALUS_FREQUENCY_INL
#else
#define TALUS_FREQUENCY_INL
#endif

#include <cstddef>

#include "core/base/simd_math-inl.hpp"
#include "core/erosion/terms.hpp"
#include "core/noise/phacelle-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What either method gives at one vector of points.
template <class V>
struct ErosionResult {
  V height, slope_x, slope_z, ridge;
  V cut, cut_x, cut_z;  ///< by fine gullies
};

/// The frequency method at lanes i.. of a row.
template <class D, class V = VecOf<D>>
HWY_INLINE ErosionResult<V> frequency_method(D d, const ErosionTerms& t, const PhacelleRow* rows, std::size_t i, V gx,
                                             V gz, V fade_target, V point_strength) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V fade = hn::Min(hn::Max(fade_target, hn::Set(d, -1.0f)), one);
  // Share of gullies by altitude: none at the fade target of a valley floor, all from half-way up.
  const V up = saturate(hn::Add(fade, one));
  const V rising = hn::Mul(hn::Mul(up, up), hn::Sub(hn::Set(d, 3.0f), hn::Add(up, up)));
  const V weight = hn::Mul(mix(one, rising, hn::Set(d, t.frequency_valley)), hn::Set(d, t.gully_weight));
  const V pull = hn::Mul(fade, hn::Set(d, t.frequency_pull));

  V gully_x = gx;
  V gully_z = gz;
  ErosionResult<V> r{zero, zero, zero, fade, zero, zero, zero};
  V ridge_mask =
      ease_out(d, hn::Mul(hn::Sqrt(hn::Add(hn::Mul(gx, gx), hn::Mul(gz, gz))), hn::Set(d, t.ridge_onset_input)));
  for (std::size_t o = 0; o < static_cast<std::size_t>(t.octaves); ++o) {
    const V steepness = hn::Sqrt(hn::Add(hn::Mul(gully_x, gully_x), hn::Mul(gully_z, gully_z)));
    const V inverse = hn::Div(one, hn::Max(steepness, hn::Set(d, 1e-10f)));
    const V nx = hn::Mul(gully_x, inverse);
    const V nz = hn::Mul(gully_z, inverse);
    const V wanted = hn::Mul(steepness, hn::Set(d, t.frequency_slope));
    const V over = hn::Div(wanted, hn::Set(d, t.frequency_max));
    const V stripes = hn::Div(wanted, hn::Sqrt(hn::Add(one, hn::Mul(over, over))));
    V cosine;
    V sine;
    phacelle(d, rows[o], i, nx, nz, hn::Mul(stripes, hn::Set(d, t.cell_scale)), zero, hn::Set(d, t.shortest), cosine,
             sine);

    const V strength = hn::Mul(point_strength, hn::Set(d, t.octave[o].strength_m));
    // Flats (cosine 1) stay where they are; gullies are cut below them.
    const V below = hn::Mul(hn::Sub(one, cosine), weight);
    r.height = hn::Add(r.height, hn::Mul(strength, hn::Sub(pull, below)));
    const V side =
        hn::Mul(hn::Mul(hn::Mul(strength, weight), hn::Mul(stripes, sine)), hn::Set(d, t.octave[o].side_slope_per_m));
    const V side_x = hn::Mul(nz, side);
    const V side_z = hn::Neg(hn::Mul(nx, side));
    r.slope_x = hn::Add(r.slope_x, side_x);
    r.slope_z = hn::Add(r.slope_z, side_z);
    const V fine = hn::Set(d, t.octave[o].fine);
    r.cut = hn::Add(r.cut, hn::Mul(hn::Mul(strength, fine), below));
    r.cut_x = hn::Sub(r.cut_x, hn::Mul(side_x, fine));
    r.cut_z = hn::Sub(r.cut_z, hn::Mul(side_z, fine));
    const V branch = hn::Set(d, t.frequency_branch);
    gully_x = hn::Add(gully_x, hn::Mul(side_x, branch));
    gully_z = hn::Add(gully_z, hn::Mul(side_z, branch));

    r.ridge = mix(r.ridge, cosine, ridge_mask);
    ridge_mask = hn::Mul(ridge_mask, ease_out(d, hn::Mul(hn::Abs(sine), hn::Set(d, t.ridge_onset_octave))));
  }
  r.ridge = hn::Mul(r.ridge, hn::Sub(one, ridge_mask));
  return r;
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_FREQUENCY_INL
