#include "core/strata/facies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/hash.hpp"
#include "core/grid/wrap.hpp"

namespace talus {
namespace {

/// The narrow octave frays the borders of the wide one.
constexpr double kNarrower = 3.0;
constexpr float kNarrowGain = 0.45f;

/// Share of places where the noise is nearer to 0 than i / kPerUnit: measured over 4 * 10^8 places, symmetric. What
/// lies beyond the last entry, 1.4 places of 10,000, counts as if it were there.
constexpr float kPerUnit = 32.0f / 0.7f;
constexpr std::array kNearerThan = std::to_array<float>(
    {0.0f,      0.091733f, 0.182060f, 0.269686f, 0.353479f, 0.432599f, 0.506340f, 0.574245f, 0.636083f,
     0.691745f, 0.741344f, 0.785058f, 0.823221f, 0.856175f, 0.884348f, 0.908147f, 0.927994f, 0.944348f,
     0.957629f, 0.968240f, 0.976605f, 0.983067f, 0.987964f, 0.991604f, 0.994254f, 0.996143f, 0.997463f,
     0.998361f, 0.998965f, 0.999358f, 0.999611f, 0.999767f, 1.0f});

float faded(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

}  // namespace

Facies::Facies(double wavelength_m, double wrap_m) {
  const auto octave = [&](double edge_m) {
    return Octave{fitted_cell_m(edge_m, wrap_m), edge_m, cells_around(edge_m, wrap_m)};
  };
  wide_ = octave(wavelength_m);
  narrow_ = octave(wavelength_m / kNarrower);
}

float Facies::noise(const Octave& octave, std::uint64_t key, const glm::dvec2& place_m) {
  const glm::dvec2 at(place_m.x / octave.edge_x_m, place_m.y / octave.edge_z_m);
  const glm::dvec2 cell(std::floor(at.x), std::floor(at.y));
  const auto x = static_cast<std::int64_t>(cell.x);
  const auto z = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell.y));
  const auto tx = static_cast<float>(at.x - cell.x);
  const auto tz = static_cast<float>(at.y - cell.y);
  const std::uint64_t west = mix64(key ^ static_cast<std::uint64_t>(wrapped(x, octave.cells_around)));
  const std::uint64_t east = mix64(key ^ static_cast<std::uint64_t>(wrapped(x + 1, octave.cells_around)));
  // Components of gradients are 16 bits each.
  const auto corner = [](std::uint64_t hash, float rx, float rz) {
    const auto component = [](std::uint64_t bits) {
      return static_cast<float>(static_cast<std::int16_t>(bits & 0xFFFFU)) * 0x1p-15f;
    };
    return component(hash >> 32) * rx + component(hash >> 48) * rz;
  };
  const float u = faded(tx);
  const float a = corner(mix64(west + z), tx, tz);
  const float b = corner(mix64(east + z), tx - 1.0f, tz);
  const float c = corner(mix64(west + z + 1), tx, tz - 1.0f);
  const float d = corner(mix64(east + z + 1), tx - 1.0f, tz - 1.0f);
  const float near = a + (b - a) * u;
  const float far = c + (d - c) * u;
  return near + (far - near) * faded(tz);
}

float Facies::quantile(std::uint64_t key, const glm::dvec2& place_m) const {
  const float v = noise(wide_, key, place_m) + kNarrowGain * noise(narrow_, ~key, place_m);
  const float at = std::min(std::abs(v) * kPerUnit, static_cast<float>(kNearerThan.size() - 1) - 0.001f);
  const auto i = static_cast<std::size_t>(at);
  const float nearer = kNearerThan[i] + (kNearerThan[i + 1] - kNearerThan[i]) * (at - static_cast<float>(i));
  const float half = 0.5f * std::min(nearer, 0.999999f);
  return v < 0.0f ? 0.5f - half : 0.5f + half;
}

}  // namespace talus
