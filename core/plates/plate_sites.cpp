#include "core/plates/plate_sites.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/hash.hpp"
#include "core/grid/floor_div.hpp"
#include "core/grid/wrap.hpp"

namespace talus {
namespace {

/// Streams of chance of one world's plates.
enum Use : std::uint64_t { kSquare = 1, kPlace, kTraits, kGroup, kContinentNoise, kSeaFloorNoise };

/// Macro cells along the square of plates that one group's centre stands for.
constexpr std::int64_t kGroupCells = 4;

std::uint64_t hash_of(std::uint64_t seed, Use use, std::int64_t x, std::int64_t z) {
  return mix64(mix64(mix64(seed, use), static_cast<std::uint64_t>(x)), static_cast<std::uint64_t>(z));
}

/// 0 <= v < 1, a new one for each `n`.
double unit(std::uint64_t hash, std::uint64_t n) {
  return static_cast<double>(mix64(hash, n) >> 11) * 0x1p-53;
}

/// Where in -1/2..1/2 a jitter of 0..1 puts a site of this hash.
double jittered(std::uint64_t hash, std::uint64_t n, double jitter) {
  return (unit(hash, n) - 0.5) * jitter;
}

/// A vector of length 1 in a direction of chance; four octants of a square blown up to the circle.
glm::vec2 direction(std::uint64_t hash) {
  const double x = 2 * unit(hash, 11) - 1;
  const double z = 2 * unit(hash, 12) - 1;
  const double length = std::sqrt(x * x + z * z) + 1e-9;
  return {static_cast<float>(x / length), static_cast<float>(z / length)};
}

float noise_at(const FractalNoise& noise, const glm::i64vec2& at_m, std::int64_t wrap_m) {
  std::array<float, kRowPadding> v;
  std::array<float, kRowPadding> x;
  std::array<float, kRowPadding> z;
  fractal_noise(noise, {at_m.x, at_m.y, 1, 1, 1, 1.0, wrap_m}, v, x, z);
  return v[0];
}

}  // namespace

SiteKey first_turn(const PlateControls& controls, const SiteKey& key) {
  return {wrapped(key.x, controls.wrap_m / static_cast<std::int64_t>(controls.size_m)), key.z};
}

PlateSites::PlateSites(const PlateControls& plates, const MacroControls& macro)
    : controls_(plates),
      macro_(macro),
      cell_m_(static_cast<std::int64_t>(plates.size_m)),
      continent_{plates.cluster_m, 3, 2.0, 0.5, mix64(plates.seed, kContinentNoise)},
      sea_floor_{plates.cluster_m * 0.6, 2, 2.0, 0.5, mix64(plates.seed, kSeaFloorNoise)} {}

std::int64_t PlateSites::square_of(std::int64_t at_m) const {
  return floor_div(at_m, square_m());
}

bool PlateSites::is_big(std::int64_t square_x, std::int64_t square_z) const {
  return unit(hash_of(controls_.seed, kSquare, wrapped(square_x, controls_.wrap_m / square_m()), square_z), 0) <
         controls_.big_share;
}

Site PlateSites::place(const SiteKey& key, bool big) const {
  const std::uint64_t hash = hash_of(controls_.seed, kPlace, first_turn(controls_, key).x, key.z);
  const double edge_m = static_cast<double>(big ? square_m() : cell_m_);
  const double jitter = big ? 0.5 * controls_.jitter : controls_.jitter;
  const auto along = [&](std::uint64_t n) {
    return static_cast<std::int64_t>(std::floor(edge_m * (0.5 + jittered(hash, n, jitter))));
  };
  return {key, {key.x * cell_m_ + along(0), key.z * cell_m_ + along(1)}};
}

void PlateSites::add_sites(std::int64_t square_x, std::int64_t square_z, std::vector<Site>& out) const {
  const SiteKey low{2 * square_x, 2 * square_z};
  if (is_big(square_x, square_z)) {
    out.push_back(place(low, true));
    return;
  }
  for (const std::int64_t x : {0, 1}) {
    for (const std::int64_t z : {0, 1}) out.push_back(place({low.x + x, low.z + z}, false));
  }
}

Site PlateSites::site(const SiteKey& key) const {
  return place(key, is_big(floor_div(key.x, 2), floor_div(key.z, 2)));
}

glm::vec2 PlateSites::group_velocity(const Site& site) const {
  const std::int64_t edge_m = kGroupCells * cell_m_;
  const glm::i64vec2 here{floor_div(site.at_m.x, edge_m), floor_div(site.at_m.y, edge_m)};
  double nearest = 1e300;
  std::uint64_t winner = 0;
  for (std::int64_t dz = -1; dz <= 1; ++dz) {
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      const glm::i64vec2 group = here + glm::i64vec2{dx, dz};
      const std::uint64_t hash = hash_of(controls_.seed, kGroup, wrapped(group.x, controls_.wrap_m / edge_m), group.y);
      const glm::i64vec2 corner = group * edge_m - site.at_m;
      const double x = static_cast<double>(corner.x) + static_cast<double>(edge_m) * (0.5 + jittered(hash, 0, 0.8));
      const double z = static_cast<double>(corner.y) + static_cast<double>(edge_m) * (0.5 + jittered(hash, 1, 0.8));
      const double distance = x * x + z * z;
      if (distance >= nearest) continue;
      nearest = distance;
      winner = hash;
    }
  }
  const double speed = (0.45 + 0.65 * unit(winner, 2)) * controls_.group_speed;
  return direction(winner) * static_cast<float>(speed);
}

PlateTraits PlateSites::traits(const Site& site) const {
  const std::uint64_t hash = hash_of(controls_.seed, kTraits, first_turn(controls_, site.key).x, site.key.z);
  // Clustered, or land would be confetti: a slow noise decides, chance scatters.
  const double q = 0.5 + 0.62 * static_cast<double>(noise_at(continent_, site.at_m, controls_.wrap_m)) +
                   controls_.scatter * (unit(hash, 0) - 0.5);
  PlateTraits traits;
  traits.kind = q < controls_.ocean ? PlateKind::kOceanic : PlateKind::kContinental;
  // Young plates are oceanic, old ones continental, and within its kind a plate sinks as it ages.
  const double u = unit(hash, 1);
  if (traits.kind == PlateKind::kContinental) {
    const double heart = std::clamp((q - controls_.ocean) / 0.45, 0.0, 1.0);
    traits.age = static_cast<float>(controls_.ocean + (1 - controls_.ocean) * u);
    traits.elevation_m = static_cast<float>(macro_.land_m + macro_.land_range_m * (heart - u));
  } else {
    const double slow = static_cast<double>(noise_at(sea_floor_, site.at_m, controls_.wrap_m));
    traits.age = static_cast<float>(controls_.ocean * u);
    traits.elevation_m = static_cast<float>(macro_.sea_floor_m + macro_.sea_range_m * (slow - 0.8 * (u - 0.5)));
  }
  traits.velocity =
      group_velocity(site) + direction(hash) * static_cast<float>(controls_.own_speed * std::sqrt(unit(hash, 2)));
  return traits;
}

}  // namespace talus
