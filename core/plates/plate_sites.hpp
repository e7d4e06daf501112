// The sites of plates: where each plate has its centre, and what it is. Pure.
//
// The plane is cut into squares of 2x2 macro cells. A square holds either one big plate or one plate per cell, which
// gives plates of two sizes and keeps every neighbourhood bounded: each square holds at least one site, so no point is
// farther than kSiteReach macro cells from the nearest site. Positions are whole metres in 64 bits, so distances
// between sites are exact anywhere.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "core/noise/gradient_noise.hpp"
#include "core/plates/plate_controls.hpp"

namespace talus {

/// The macro cell of a site (the lower one of its square's four for a big plate): its identity, and its order.
struct SiteKey {
  std::int64_t x = 0;
  std::int64_t z = 0;
  friend auto operator<=>(const SiteKey&, const SiteKey&) = default;
};

struct Site {
  SiteKey key;
  glm::i64vec2 at_m{};  ///< whole metres from the world's origin
  friend bool operator==(const Site&, const Site&) = default;
};

enum class PlateKind : std::uint8_t { kOceanic, kContinental };

struct PlateTraits {
  PlateKind kind = PlateKind::kOceanic;
  float age = 0;          ///< 0 (young: oceanic) .. 1 (old: continental)
  float elevation_m = 0;  ///< mean height
  glm::vec2 velocity{};   ///< about 1 for a fast plate; its unit is the classes' own
};

/// The farthest a point can be from its nearest site, in macro cells: a big plate's site keeps to 0.275..0.725 of its
/// square (jitter 0.9), so its square's farthest corner is 0.725 * 2 * sqrt(2) = 2.051 cells away; a cell's own site is
/// at most 0.95 * sqrt(2) = 1.344 away.
inline constexpr double kSiteReach = 2.06;

/// In a world that wraps, the key that the site of `key` has in the first turn around it: what chance is drawn from.
/// Orders and distances are those of the keys themselves, which a whole turn moves alike.
SiteKey first_turn(const PlateControls& controls, const SiteKey& key);

class PlateSites {
 public:
  PlateSites(const PlateControls& plates, const MacroControls& macro);

  std::int64_t square_m() const { return 2 * cell_m_; }  ///< edge of a square of 2x2 macro cells
  /// The square that holds a coordinate in whole metres.
  std::int64_t square_of(std::int64_t at_m) const;
  /// Appends the sites of one square, one or four.
  void add_sites(std::int64_t square_x, std::int64_t square_z, std::vector<Site>& out) const;
  /// The site of a key that add_sites gave.
  Site site(const SiteKey& key) const;
  PlateTraits traits(const Site& site) const;

 private:
  bool is_big(std::int64_t square_x, std::int64_t square_z) const;
  Site place(const SiteKey& key, bool big) const;
  glm::vec2 group_velocity(const Site& site) const;

  PlateControls controls_;
  MacroControls macro_;
  std::int64_t cell_m_;
  FractalNoise continent_;
  FractalNoise sea_floor_;
};

}  // namespace talus
