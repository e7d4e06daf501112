// Which plate a point lies on, and the fault next to it. Pure.
//
// The ground passes softly from plate to plate; this is the sharp answer, for maps, queries and proofs. The plane is
// cut into kites, two triangles between a fault's straight line and its two sites; a fault's curve stays within its
// kite, so a point belongs to the nearest site's plate unless it lies beyond the curve in its kite: then to the plate
// behind. Every point has exactly one owner.
#pragma once

#include <glm/vec2.hpp>

#include "core/plates/macro_field.hpp"

namespace talus {

struct PlatePlace {
  Site plate;
  PlateTraits traits;
  Site neighbour;        ///< the plate behind the nearest fault
  FaultClass fault{};    ///< what that fault is
  bool is_front = true;  ///< whether this plate is that fault's front plate
  float fault_m = 0;     ///< distance to that fault, positive on its front plate, as profiles take it
};

/// `place_m` in metres from the world's origin.
PlatePlace place_at(const PlateBuilder& plates, const glm::dvec2& place_m, PlateMemo& memo);

}  // namespace talus
