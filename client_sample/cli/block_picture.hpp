// A cliff as one sees it from a ship: a block of a world drawn without perspective, with its caves, arches and beds.
// Deterministic on one processor.
#pragma once

#include <glm/vec3.hpp>

#include "client_sample/cli/map_picture.hpp"
#include "core/world/world_function.hpp"

namespace talus::cli {

struct BlockView {
  glm::dvec3 middle_m{};  ///< what is in the middle of the picture
  double yaw = 0;         ///< degrees; 0 looks along -z, grows to the left
  double pitch = -15;     ///< degrees, below 0 looks down
  double width_m = 150;   ///< across the picture, at most 200
};

/// `width` x `height` pixels.
Picture draw_block(const WorldFunction& world, const BlockView& view, int width, int height);

}  // namespace talus::cli
