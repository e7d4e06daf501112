// What happens where two plates meet: the class of a fault and the size of what it raises. Pure.
//
// Everything here follows from the two sites alone, never from the polygons, so that a third plate that only touches
// the fault's end knows its crest too.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/plates/plate_sites.hpp"

namespace talus {

enum class FaultClass : std::uint8_t {
  kCollision,   ///< two continents close in: a double range and a plateau
  kSubduction,  ///< sea floor dives under a continent: a trench, and a range inland
  kIslandArc,   ///< sea floor dives under sea floor: a trench, and islands
  kOceanRidge,  ///< sea floor parts: a ridge with a notch along it
  kRift,        ///< a continent parts: a valley between raised shoulders
  kOldLand,     ///< two continents at rest: low hills along some faults, none along most
  kOldSea,      ///< two oceanic plates at rest
  kPassive,     ///< a coast at rest
};

/// Half the distance of two sites from which what lies along their fault has its full width, in metres.
inline constexpr double kFullWidth_m = 6500;

/// Names as routes and maps show them.
constexpr std::string_view name_of(FaultClass fault) {
  constexpr std::string_view kNames[] = {"collision", "subduction", "island_arc", "ocean_ridge",
                                         "rift",      "old_land",   "old_sea",    "passive"};
  return kNames[static_cast<std::size_t>(fault)];
}

/// A plate's site together with what the plate is.
struct PlateSeat {
  Site site;
  PlateTraits traits;
};

/// The size of a fault's features, the same from both sides. Positive distances lie on the front plate: the land at a
/// coast, the plate that stays above where one dives, else the one that is first by its key.
struct FaultFeatures {
  FaultClass kind = FaultClass::kOldSea;
  float scale = 1;      ///< of lengths across the fault: small plates have narrow ranges
  float crest_m = 0;    ///< uplift along the crest
  float trench_m = 0;   ///< depth of the trench below the sea floor
  float hilliness = 0;  ///< along the crest
};

/// Whether `a` is the front plate of the fault between `a` and `b`; exactly one of (a, b) and (b, a) is.
bool is_front(const PlateSeat& a, const PlateSeat& b);

/// Requires is_front(front, back).
FaultFeatures features_of(const PlateControls& plates, const MacroControls& macro, const PlateSeat& front,
                          const PlateSeat& back);

}  // namespace talus
