// A vertical cut through the world: rock with its layers and caves, sea, sky. Pure.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "core/world/density_brick.hpp"
#include "core/world/world_function.hpp"

namespace talus {

struct SectionView {
  glm::dvec2 from_m{};  ///< x, z of the left edge
  glm::dvec2 to_m{};    ///< of the right edge
  double low_m = 0;     ///< height of the lower edge
  double high_m = 0;    ///< of the upper edge
  int width = 0;        ///< pixels
  int height = 0;
};

/// Working memory of one thread.
struct SectionScratch {
  DensityBrick brick;
};

/// Lowest and highest surface below the line, in metres, from `count` columns along it.
glm::dvec2 section_heights(const WorldFunction& world, const SectionView& view, int count, SectionScratch& scratch);

/// Fills column `i` of the picture: `rgb` is 3 * width * height bytes, sRGB, rows from top to bottom. Columns are
/// independent of one another.
void draw_section_column(const WorldFunction& world, const SectionView& view, int i, SectionScratch& scratch,
                         std::span<std::uint8_t> rgb);

}  // namespace talus
