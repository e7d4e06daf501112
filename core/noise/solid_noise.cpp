#include "core/noise/solid_noise.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/noise/solid_noise.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void solid_noise_row_target(const SolidRow& row, std::size_t width, float amplitude, float* HWY_RESTRICT value) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::RebindToUnsigned<decltype(d)> du;
  using V = hn::Vec<decltype(d)>;
  const V one = hn::Set(d, 1.0f);
  const auto fade = [&](V t) {
    const V inner = hn::Add(hn::Mul(t, hn::Sub(hn::Mul(t, hn::Set(d, 6.0f)), hn::Set(d, 15.0f))), hn::Set(d, 10.0f));
    return hn::Mul(hn::Mul(hn::Mul(t, t), t), inner);
  };
  const V ty = hn::Set(d, row.fraction_y);
  const V tz = hn::Set(d, row.fraction_z);
  const V fade_y = fade(ty);
  const V fade_z = fade(tz);
  // Components are ten bits, 0..1023, taken as -1 .. +1.
  const V scale = hn::Set(d, 2.0f / 1023.0f);
  const V amplitude_v = hn::Set(d, amplitude);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const V tx = hn::LoadU(d, &row.x->fraction[i]);
    const V fade_x = fade(tx);
    const auto corner = [&](std::size_t cx, std::size_t cy, std::size_t cz) {
      const std::uint32_t yz = row.hash_y[cy] ^ row.hash_z[cz];
      auto h = hn::Xor(hn::LoadU(du, &row.x->cell_hash[cx][i]), hn::Set(du, yz));
      h = hn::Xor(h, hn::ShiftRight<16>(h));
      h = hn::Mul(h, hn::Set(du, 0x85EBCA6BU));
      h = hn::Xor(h, hn::ShiftRight<13>(h));
      h = hn::Mul(h, hn::Set(du, 0xC2B2AE35U));
      const auto component = [&](auto bits) {
        const V v = hn::ConvertTo(d, hn::BitCast(di, hn::And(bits, hn::Set(du, 1023U))));
        return hn::Sub(hn::Mul(v, scale), one);
      };
      const V rx = cx == 0 ? tx : hn::Sub(tx, one);
      const V ry = cy == 0 ? ty : hn::Sub(ty, one);
      const V rz = cz == 0 ? tz : hn::Sub(tz, one);
      return hn::Add(
          hn::Add(hn::Mul(component(hn::ShiftRight<22>(h)), rx), hn::Mul(component(hn::ShiftRight<12>(h)), ry)),
          hn::Mul(component(hn::ShiftRight<2>(h)), rz));
    };
    const auto between = [](V a, V b, V t) { return hn::Add(a, hn::Mul(t, hn::Sub(b, a))); };
    const auto edge = [&](std::size_t cy, std::size_t cz) {
      return between(corner(0, cy, cz), corner(1, cy, cz), fade_x);
    };
    const V near = between(edge(0, 0), edge(1, 0), fade_y);
    const V far = between(edge(0, 1), edge(1, 1), fade_y);
    const V noise = between(near, far, fade_z);
    hn::StoreU(hn::Add(hn::LoadU(d, value + i), hn::Mul(noise, amplitude_v)), d, value + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(solid_noise_row_target);

void add_solid_noise_row(const SolidRow& row, std::size_t width, float amplitude, float* value) {
  HWY_DYNAMIC_DISPATCH(solid_noise_row_target)(row, width, amplitude, value);
}

}  // namespace talus
#endif  // HWY_ONCE
