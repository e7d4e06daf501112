// Any square of the world as a picture of any size. Deterministic: the same bytes for any number of processors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/map/draw_map.hpp"

namespace talus::cli {

struct MapArea {
  glm::dvec2 centre_m{};  ///< x, z
  double edge_m = 0;
};

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< rows from top to bottom
};

/// A map of `area` with `size` pixels along each edge: drawn on the lattice whose spacing is nearest below a pixel,
/// then resampled. Shows progress.
Picture draw_picture(const WorldFunction& world, const MapArea& area, int size, const MapStyle& style);

/// "x,z,km"; says on standard error what is wrong with it.
std::optional<MapArea> area_of(const std::string& text);

/// As a PNG; says on standard error what failed.
bool store_picture(const std::string& path, const Picture& picture);

}  // namespace talus::cli
