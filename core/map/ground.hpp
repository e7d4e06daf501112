// What lies under the pixels of a map, before light falls on it. Pure.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "core/map/map_view.hpp"
#include "core/map/palette.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// Means over each pixel. Pixel (i, k) of the view is at (k + margin) * stride + (i + margin).
struct Ground {
  int margin = 0;  ///< pixels known beyond each edge of the view
  std::size_t stride = 0;
  std::vector<float> height_m;    ///< of the surface, under water too
  std::vector<float> wet;         ///< share below the sea, 0..1
  std::vector<glm::vec3> colour;  ///< light that the dry part (every part, for layers without a sea) throws back
};

/// Working memory of one thread.
struct MapScratch {
  ColumnBlock columns;
  ColumnWorkspace plates;
  Ground ground;
};

/// Fills scratch.ground for `view` and `margin` pixels around it.
void gather_ground(const WorldFunction& world, const MapView& view, MapLayer layer, int margin, MapScratch& scratch);

/// Whether the sea is painted over a layer, or its floor shown like land.
constexpr bool has_sea(MapLayer layer) {
  return layer == MapLayer::kShaded || layer == MapLayer::kMaterial || layer == MapLayer::kLayer;
}

}  // namespace talus
