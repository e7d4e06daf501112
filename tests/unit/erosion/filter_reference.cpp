#include "tests/unit/erosion/filter_reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/base/hash.hpp"

namespace talus::test {
namespace {

double sat(double t) {
  return std::clamp(t, 0.0, 1.0);
}
double mix(double a, double b, double t) {
  return a + (b - a) * t;
}
double ease_out(double t) {
  return 1 - (1 - sat(t)) * (1 - sat(t));
}
double pow_inv(double t, double k) {
  return 1 - std::pow(1 - sat(t), k);
}
double smooth_start(double t, double r) {
  return t >= r ? t - r / 2 : t * t / (2 * r);
}

struct Vec {
  double x, z;
};
Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.z + b.z};
}
Vec operator*(Vec a, double k) {
  return {a.x * k, a.z * k};
}
double length(Vec a) {
  return std::hypot(a.x, a.z);
}

/// The jitter of a cell: which random numbers a cell has is a convention shared with the filter, not part of the
/// formulas.
Vec jitter_of(std::int64_t cx, std::int64_t cz, std::uint64_t octave_seed) {
  const auto axis = [&](std::int64_t cell, std::uint64_t direction) {
    return static_cast<std::uint32_t>(mix64(mix64(octave_seed, direction), static_cast<std::uint64_t>(cell)));
  };
  std::uint32_t h = axis(cx, 0) ^ axis(cz, 1);
  h = (h ^ h >> 16) * 0x85EBCA6BU;
  h = (h ^ h >> 13) * 0xC2B2AE35U;
  const auto half = [](std::uint32_t bits) { return static_cast<double>(static_cast<std::int16_t>(bits)) / 65536.0; };
  return {half(h & 0xFFFFU), half(h >> 16)};
}

/// (cosine, sine) of the stripes at p, in cells, along the unit direction n.
Vec phacelle(Vec p, Vec n, double frequency, double offset, double normalisation, std::uint64_t seed) {
  const Vec s{-n.z * 2 * std::numbers::pi * frequency, n.x * 2 * std::numbers::pi * frequency};
  Vec sum{0, 0};
  double weights = 0;
  const auto cell_x = static_cast<std::int64_t>(std::floor(p.x));
  const auto cell_z = static_cast<std::int64_t>(std::floor(p.z));
  for (std::int64_t k = -1; k <= 2; ++k) {
    for (std::int64_t j = -1; j <= 2; ++j) {
      const Vec jitter = jitter_of(cell_x + j, cell_z + k, seed);
      const Vec v{p.x - static_cast<double>(cell_x + j) - jitter.x, p.z - static_cast<double>(cell_z + k) - jitter.z};
      const double weight = std::max(0.0, std::exp(-2 * (v.x * v.x + v.z * v.z)) - 0.01111);
      const double angle = v.x * s.x + v.z * s.z + 2 * std::numbers::pi * offset;
      sum = sum + Vec{std::cos(angle), std::sin(angle)} * weight;
      weights += weight;
    }
  }
  const Vec mean = sum * (1 / weights);
  return mean * (1 / std::max(1 - normalisation, length(mean)));
}

/// The shift of an octave's lattice, a convention shared with split_axis.
double shift_of(std::uint64_t octave_seed, std::uint64_t direction) {
  return static_cast<double>(mix64(octave_seed, direction) >> 40) / 16384.0;
}

}  // namespace

ErosionPoint erode_reference(const ErosionControls& c, double x_m, double z_m, double slope_x, double slope_z,
                             double fade_target, double point_strength) {
  const Vec g{slope_x, slope_z};
  double fade = std::clamp(fade_target, -1.0, 1.0);
  const double steep = length(g);
  const double r_in = mix(c.rounding_crease, c.rounding_ridge, sat(fade + 0.5)) * c.rounding_input;
  double mask = ease_out(smooth_start(steep * c.onset_input, r_in * c.onset_input));
  Vec gully = g * (1 - c.assumed_blend) + g * (steep > 0 ? c.assumed_slope / steep * c.assumed_blend : 0.0);
  double ridge_mask = ease_out(steep * c.ridge_onset_input);
  double ridge_target = fade;

  ErosionPoint out;
  double magnitude = 0;
  double strength = c.strength * c.scale_m * point_strength;
  double frequency = 1 / (c.scale_m * c.cell_scale);
  double rounding = 1;
  for (int o = 0; o < c.octaves; ++o) {
    const std::uint64_t seed = mix64(c.seed, static_cast<std::uint64_t>(o));
    const Vec n = gully * (1 / std::max(length(gully), 1e-10));
    const Vec p{x_m * frequency + shift_of(seed, 0), z_m * frequency + shift_of(seed, 1)};
    const Vec wave = phacelle(p, n, c.cell_scale, 0.25, c.normalisation, seed);
    const double cosine = wave.x;
    const double sine = wave.z;
    const Vec side = Vec{-n.z, n.x} * (2 * std::numbers::pi * c.cell_scale) * -frequency;
    gully = gully + side * ((sine < 0 ? -1.0 : 1.0) * strength * c.gully_weight);
    const double faded = mix(fade, cosine * c.gully_weight, mask);
    out.height_m += faded * strength;
    out.slope_x += mask * sine * side.x * strength * c.gully_weight;
    out.slope_z += mask * sine * side.z * strength * c.gully_weight;
    magnitude += strength;
    fade = faded;
    const double r_octave = mix(c.rounding_crease, c.rounding_ridge, sat(cosine + 0.5)) * rounding;
    const double fresh = ease_out(smooth_start(std::abs(sine) * c.onset_octave, r_octave * c.onset_octave));
    mask = pow_inv(mask, c.detail) * fresh;
    ridge_target = mix(ridge_target, cosine, ridge_mask);
    ridge_mask *= ease_out(std::abs(sine) * c.ridge_onset_octave);
    strength *= c.gain;
    frequency *= c.lacunarity;
    rounding *= c.rounding_octave;
  }
  out.height_m += c.offset * magnitude;
  out.ridge = ridge_target * (1 - ridge_mask);
  return out;
}

ErosionPoint erode_by_frequency_reference(const ErosionControls& c, double x_m, double z_m, double slope_x,
                                          double slope_z, double fade_target, double point_strength) {
  Vec gully{slope_x, slope_z};
  const double fade = std::clamp(fade_target, -1.0, 1.0);
  const double up = sat(fade + 1);
  const double weight = c.gully_weight * mix(1, up * up * (3 - 2 * up), c.frequency_valley);
  ErosionPoint out;
  out.ridge = fade;
  double ridge_mask = ease_out(length(gully) * c.ridge_onset_input);
  double strength = c.strength * c.scale_m * point_strength;
  double frequency = 1 / (c.scale_m * c.cell_scale);
  for (int o = 0; o < c.octaves; ++o) {
    const std::uint64_t seed = mix64(c.seed, static_cast<std::uint64_t>(o));
    const double steep = length(gully);
    const Vec n = gully * (1 / std::max(steep, 1e-10));
    const double wanted = steep * c.frequency_slope;
    const double stripes = c.cell_scale * wanted / std::hypot(1.0, wanted / c.frequency_max);
    const Vec p{x_m * frequency + shift_of(seed, 0), z_m * frequency + shift_of(seed, 1)};
    const Vec wave = phacelle(p, n, stripes, 0, c.normalisation, seed);
    out.height_m += strength * (weight * (wave.x - 1) + c.frequency_pull * fade);
    const Vec side = Vec{-n.z, n.x} * (-2 * std::numbers::pi * stripes * frequency * strength * weight * wave.z);
    out.slope_x += side.x;
    out.slope_z += side.z;
    gully = gully + side * c.frequency_branch;
    out.ridge = mix(out.ridge, wave.x, ridge_mask);
    ridge_mask *= ease_out(std::abs(wave.z) * c.ridge_onset_octave);
    strength *= c.gain;
    frequency *= c.lacunarity;
  }
  out.ridge *= 1 - ridge_mask;
  return out;
}

}  // namespace talus::test
