#include "core/noise/gradient_noise.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"
#include "core/grid/axis.hpp"

#ifndef TALUS_GRADIENT_NOISE_ROW
#define TALUS_GRADIENT_NOISE_ROW
namespace talus {

/// One octave along one row of columns.
struct OctaveRow {
  const Axis* x;
  float fraction_z;
  std::array<std::uint32_t, 2> hash_z;
  float amplitude;          ///< of the value; includes kNoiseScale and the 2^-15 of the gradients
  float slope_amplitude_x;  ///< of the slope: amplitude * cells per metre
  float slope_amplitude_z;
};

}  // namespace talus
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/noise/gradient_noise.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Highway needs its own header after foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Mixes the word of a lattice corner; both halves of the result are a gradient component, uniform in +-2^15.
/// The steps are those of the 32-bit finaliser of MurmurHash3 (A. Appleby, 2011) without its last shift.
template <class V>
HWY_INLINE V corner_hash(V h) {
  const hn::DFromV<V> du;
  h = hn::Xor(h, hn::ShiftRight<16>(h));
  h = hn::Mul(h, hn::Set(du, 0x85EBCA6BU));
  h = hn::Xor(h, hn::ShiftRight<13>(h));
  return hn::Mul(h, hn::Set(du, 0xC2B2AE35U));
}

void add_octave(const OctaveRow& row, std::size_t width, float* HWY_RESTRICT value, float* HWY_RESTRICT slope_x,
                float* HWY_RESTRICT slope_z) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::RebindToUnsigned<decltype(d)> du;
  using V = hn::Vec<decltype(d)>;
  const auto one = hn::Set(d, 1.0f);

  // Quintic fade 6t^5 - 15t^4 + 10t^3 and its derivative 30 t^2 (t - 1)^2.
  const auto fade = [&](V t) {
    const V inner = hn::Add(hn::Mul(t, hn::Sub(hn::Mul(t, hn::Set(d, 6.0f)), hn::Set(d, 15.0f))), hn::Set(d, 10.0f));
    return hn::Mul(hn::Mul(hn::Mul(t, t), t), inner);
  };
  const auto fade_slope = [&](V t) {
    const V a = hn::Mul(t, hn::Sub(t, one));
    return hn::Mul(hn::Set(d, 30.0f), hn::Mul(a, a));
  };

  const V tz = hn::Set(d, row.fraction_z);
  const V tz1 = hn::Sub(tz, one);
  const V w = fade(tz);
  const V dw = fade_slope(tz);
  const auto z0 = hn::Set(du, row.hash_z[0]);
  const auto z1 = hn::Set(du, row.hash_z[1]);
  const V amplitude = hn::Set(d, row.amplitude);
  const V amplitude_x = hn::Set(d, row.slope_amplitude_x);
  const V amplitude_z = hn::Set(d, row.slope_amplitude_z);

  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const V tx = hn::LoadU(d, &row.x->fraction[i]);
    const V tx1 = hn::Sub(tx, one);
    const V u = fade(tx);
    const V du_dx = fade_slope(tx);
    const auto x0 = hn::LoadU(du, &row.x->cell_hash[0][i]);
    const auto x1 = hn::LoadU(du, &row.x->cell_hash[1][i]);

    const auto corner = [&](auto hx, auto hz, V rx, V rz, V& gx, V& gz) {
      const auto h = corner_hash(hn::Xor(hx, hz));
      gx = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(hn::BitCast(di, h))));
      gz = hn::ConvertTo(d, hn::ShiftRight<16>(hn::BitCast(di, h)));
      return hn::Add(hn::Mul(gx, rx), hn::Mul(gz, rz));
    };
    V gx00, gz00, gx10, gz10, gx01, gz01, gx11, gz11;
    const V a = corner(x0, z0, tx, tz, gx00, gz00);
    const V b = corner(x1, z0, tx1, tz, gx10, gz10);
    const V c = corner(x0, z1, tx, tz1, gx01, gz01);
    const V e = corner(x1, z1, tx1, tz1, gx11, gz11);

    // Bilinear in (u, w): p0 + p1 u + p2 w + p3 u w.
    const auto blend = [&](V p00, V p10, V p01, V p11) {
      const V low = hn::Add(p00, hn::Mul(u, hn::Sub(p10, p00)));
      const V high = hn::Add(p01, hn::Mul(u, hn::Sub(p11, p01)));
      return hn::Add(low, hn::Mul(w, hn::Sub(high, low)));
    };
    const V across_x = hn::Add(hn::Sub(b, a), hn::Mul(w, hn::Sub(hn::Sub(e, c), hn::Sub(b, a))));
    const V across_z = hn::Add(hn::Sub(c, a), hn::Mul(u, hn::Sub(hn::Sub(e, b), hn::Sub(c, a))));
    const V n = blend(a, b, c, e);
    const V nx = hn::Add(blend(gx00, gx10, gx01, gx11), hn::Mul(du_dx, across_x));
    const V nz = hn::Add(blend(gz00, gz10, gz01, gz11), hn::Mul(dw, across_z));

    hn::StoreU(hn::Add(hn::LoadU(d, value + i), hn::Mul(n, amplitude)), d, value + i);
    hn::StoreU(hn::Add(hn::LoadU(d, slope_x + i), hn::Mul(nx, amplitude_x)), d, slope_x + i);
    hn::StoreU(hn::Add(hn::LoadU(d, slope_z + i), hn::Mul(nz, amplitude_z)), d, slope_z + i);
  }
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {
HWY_EXPORT(add_octave);

double noise_bound(const FractalNoise& noise) {
  double sum = 0;
  double amplitude = kNoiseScale;
  for (int o = 0; o < noise.octaves; ++o) {
    sum += amplitude;
    amplitude *= noise.gain;
  }
  return sum;
}

void fractal_noise(const FractalNoise& noise, const ColumnGrid& grid, std::span<float> value, std::span<float> slope_x,
                   std::span<float> slope_z) {
  TALUS_CHECK(noise.octaves >= 1 && noise.octaves <= kNoiseOctavesMax && noise.stretch_z > 0);
  TALUS_CHECK(grid.width >= 1 && grid.width <= kColumnsMax && grid.depth >= 1 && grid.depth <= kColumnsMax);
  const std::size_t stride = row_stride(grid);
  const std::size_t count = sample_count(grid);
  TALUS_CHECK(value.size() >= count && slope_x.size() >= count && slope_z.size() >= count);
  for (const auto& span : {value, slope_x, slope_z}) std::fill_n(span.begin(), count, 0.0f);

  Axis x;
  Axis z;
  double amplitude = static_cast<double>(kNoiseScale) * 0x1p-15;
  double cells_per_m = 1.0 / noise.wavelength_m;
  for (int o = 0; o < noise.octaves; ++o) {
    const Octave octave = octave_on(grid, cells_per_m, mix64(noise.seed, static_cast<std::uint64_t>(o)));
    const double cells_per_m_z = octave.cells_per_m / noise.stretch_z;
    split_axis(octave, 0, grid.x_voxel, grid.step_voxel, grid.voxel_m, grid.width, 0, 2, x);
    split_axis({cells_per_m_z, octave.seed}, 1, grid.z_voxel, grid.step_voxel, grid.voxel_m, grid.depth, 0, 2, z);
    const auto add = HWY_DYNAMIC_DISPATCH(add_octave);
    for (int k = 0; k < grid.depth; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const OctaveRow row{&x,
                          z.fraction[at],
                          {z.cell_hash[0][at], z.cell_hash[1][at]},
                          static_cast<float>(amplitude),
                          static_cast<float>(amplitude * octave.cells_per_m),
                          static_cast<float>(amplitude * cells_per_m_z)};
      add(row, static_cast<std::size_t>(grid.width), &value[at * stride], &slope_x[at * stride], &slope_z[at * stride]);
    }
    amplitude *= noise.gain;
    cells_per_m *= noise.lacunarity;
  }
}

}  // namespace talus
#endif  // HWY_ONCE
