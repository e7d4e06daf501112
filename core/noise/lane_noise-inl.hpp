// Gradient noise at places that differ lane by lane, for small coordinates; value only.
// Include inside a file that Highway compiles once per target. Grids of columns use gradient_noise.hpp, which is exact
// at any distance and hashes cells once per row instead of once per point.

#if defined(TALUS_LANE_NOISE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_LANE_NOISE_INL
#undef TALUS_LANE_NOISE_INL
#else
#define TALUS_LANE_NOISE_INL
#endif

#include "core/base/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Noise of wavelength 1 at (x, z), |x|, |z| < 2^16: standard deviation 0.28, within +-1.6, as kNoiseScale has it.
/// The hash is the 32-bit finaliser of MurmurHash3 (A. Appleby, 2011).
template <class D, class V = VecOf<D>>
HWY_INLINE V lane_noise(D d, V x, V z, std::uint32_t seed) {
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
  const V one = hn::Set(d, 1.0f);
  const V x_cell = hn::Floor(x);
  const V z_cell = hn::Floor(z);
  const V tx = hn::Sub(x, x_cell);
  const V tz = hn::Sub(z, z_cell);
  const auto fade = [&](V t) {
    const V inner = hn::Add(hn::Mul(t, hn::Sub(hn::Mul(t, hn::Set(d, 6.0f)), hn::Set(d, 15.0f))), hn::Set(d, 10.0f));
    return hn::Mul(hn::Mul(hn::Mul(t, t), t), inner);
  };
  const auto x_hash = hn::Mul(hn::BitCast(du, hn::ConvertTo(di, x_cell)), hn::Set(du, 0x9E3779B1U));
  const auto z_hash =
      hn::Add(hn::Mul(hn::BitCast(du, hn::ConvertTo(di, z_cell)), hn::Set(du, 0xC2B2AE3DU)), hn::Set(du, seed));
  const auto corner = [&](std::uint32_t right, std::uint32_t up, V rx, V rz) {
    auto h = hn::Xor(hn::Add(x_hash, hn::Set(du, right * 0x9E3779B1U)), hn::Add(z_hash, hn::Set(du, up * 0xC2B2AE3DU)));
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<16>(h)), hn::Set(du, 0x85EBCA6BU));
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<13>(h)), hn::Set(du, 0xC2B2AE35U));
    h = hn::Xor(h, hn::ShiftRight<16>(h));
    const V gx = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(hn::BitCast(di, h))));
    const V gz = hn::ConvertTo(d, hn::ShiftRight<16>(hn::BitCast(di, h)));
    return hn::Add(hn::Mul(gx, rx), hn::Mul(gz, rz));
  };
  const V a = corner(0, 0, tx, tz);
  const V b = corner(1, 0, hn::Sub(tx, one), tz);
  const V c = corner(0, 1, tx, hn::Sub(tz, one));
  const V e = corner(1, 1, hn::Sub(tx, one), hn::Sub(tz, one));
  const V u = fade(tx);
  return hn::Mul(mix(mix(a, b, u), mix(c, e, u), fade(tz)), hn::Set(d, 1.6f * 0x1p-15f));
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_LANE_NOISE_INL
