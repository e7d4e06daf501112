// The way through a headland: where an arch can stand. Pure.
#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "core/volume/controls.hpp"
#include "core/volume/relief_tiles.hpp"

namespace talus {

/// Water on both sides of rock that is high enough.
struct ArchWay {
  glm::vec2 along;  ///< unit
  float length_m;
  float radius_m;  ///< largest that leaves a roof and legs
};

/// From a seed at the foot of a wall, looking inland: the shortest way out again, or nothing where there is none, the
/// crest is too low or a leg would not stand.
std::optional<ArchWay> find_arch(const CarveControls& controls, Relief& relief, glm::dvec2 seed_m, float seed_y_m,
                                 glm::vec2 inland);

}  // namespace talus
