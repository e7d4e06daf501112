// Phacelle noise: stripes of one frequency along a direction that varies from point to point, as a cosine and a sine.
//
// Problem: stripes turned about one far pivot are torn apart where the direction changes. Answer: every cell has a near
// pivot of its own, and the stripes of the 4x4 nearest are blended as points on the unit circle, so that misaligned
// waves give a wave again. Based on: R. Johansen, "Phacelle Noise", 2026 (description). Include inside a file that
// Highway compiles once per target.

#if defined(TALUS_PHACELLE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_PHACELLE_INL
#undef TALUS_PHACELLE_INL
#else
#define TALUS_PHACELLE_INL
#endif

#include <array>
#include <cstddef>

#include "core/base/simd_math-inl.hpp"
#include "core/grid/axis.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One row of an octave's cells as the noise sees it.
struct PhacelleRow {
  const Axis* x;  ///< four taps from -1
  float fraction_z;
  std::array<std::uint32_t, 4> hash_z;
};

/// Weight below which a pivot no longer counts: exp(-2 * 1.5^2), so that weights reach 0 at 1.5 cells.
inline constexpr float kPhacelleFloor = 0.01111f;
inline constexpr float kPhacelleReach2 = 2.25f;

/// Stripes at lanes i.. of the row along the unit direction (nx, nz), `frequency` stripes per cell, phase `offset` in
/// cycles. `shortest` = 1 - normalisation: interpolated waves at least that long are brought to length 1.
template <class D, class V = VecOf<D>>
HWY_INLINE void phacelle(D d, const PhacelleRow& row, std::size_t i, V nx, V nz, V frequency, V offset, V shortest,
                         V& cosine, V& sine) {
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
  // Distances are in units of 2^-16 cell, in which jitter is a whole number: no multiplication brings it to scale.
  const V units = hn::Set(d, 0x1p16f);
  const V units_to_cells = hn::Set(d, 0x1p-16f);
  // perp(n) = (-nz, nx); the angle in cycles is v . perp(n) * frequency + offset.
  const V per_unit = hn::Mul(frequency, units_to_cells);
  const V sx = hn::Neg(hn::Mul(nz, per_unit));
  const V sz = hn::Mul(nx, per_unit);
  const V fx = hn::Mul(hn::LoadU(d, &row.x->fraction[i]), units);
  const V fz = hn::Mul(hn::Set(d, row.fraction_z), units);
  const V reach2 = hn::Set(d, kPhacelleReach2 * 0x1p32f);
  V sum_cos = hn::Zero(d);
  V sum_sin = hn::Zero(d);
  V sum_weight = hn::Zero(d);
  for (int k = 0; k < 4; ++k) {
    const auto hash_z = hn::Set(du, row.hash_z[static_cast<std::size_t>(k)]);
    const V rz = hn::Sub(fz, hn::Set(d, static_cast<float>(k - 1) * 0x1p16f));
    for (int j = 0; j < 4; ++j) {
      auto h = hn::Xor(hn::LoadU(du, &row.x->cell_hash[static_cast<std::size_t>(j)][i]), hash_z);
      h = hn::Mul(hn::Xor(h, hn::ShiftRight<16>(h)), hn::Set(du, 0x85EBCA6BU));
      h = hn::Mul(hn::Xor(h, hn::ShiftRight<13>(h)), hn::Set(du, 0xC2B2AE35U));
      const auto signed_hash = hn::BitCast(di, h);
      const V jitter_x = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(signed_hash)));
      const V jitter_z = hn::ConvertTo(d, hn::ShiftRight<16>(signed_hash));
      const V vx = hn::Sub(hn::Sub(fx, hn::Set(d, static_cast<float>(j - 1) * 0x1p16f)), jitter_x);
      const V vz = hn::Sub(rz, jitter_z);
      const V r2 = hn::Add(hn::Mul(vx, vx), hn::Mul(vz, vz));
      // Leaving a pivot out adds an exact zero, so whether its neighbours in the vector need it changes no bit.
      if (hn::AllFalse(d, hn::Lt(r2, reach2))) continue;
      const V bell = exp_to_minus_4_5(d, hn::Mul(hn::Min(r2, reach2), hn::Set(d, -2.0f * 0x1p-32f)));
      const V weight = hn::Max(hn::Sub(bell, hn::Set(d, kPhacelleFloor)), hn::Zero(d));
      const V cycles = hn::Add(hn::Add(hn::Mul(vx, sx), hn::Mul(vz, sz)), offset);
      V c;
      V s;
      cos_sin_cycles(d, cycles, c, s);
      sum_cos = hn::Add(sum_cos, hn::Mul(weight, c));
      sum_sin = hn::Add(sum_sin, hn::Mul(weight, s));
      sum_weight = hn::Add(sum_weight, weight);
    }
  }
  // No point is further than sqrt(2) from its nearest pivot, so the weights add up to more than exp(-4) - 0.01111 =
  // 0.007.
  const V length2 = hn::Add(hn::Mul(sum_cos, sum_cos), hn::Mul(sum_sin, sum_sin));
  const V length = hn::Max(hn::Sqrt(length2), hn::Mul(shortest, sum_weight));
  cosine = hn::Div(sum_cos, length);
  sine = hn::Div(sum_sin, length);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_PHACELLE_INL
