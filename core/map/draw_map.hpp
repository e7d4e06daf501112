// A map of the world, seen from above: hill-shaded, tinted by height and ground, with a sea. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "core/map/ground.hpp"
#include "core/map/map_view.hpp"

namespace talus {

/// Fills `rgb` (3 * width * height bytes, sRGB, rows from top to bottom). A pixel's colour depends on its place, its
/// size, its samples and the style, never on the view around it: tiles meet without seams.
void draw_map(const WorldFunction& world, const MapView& view, const MapStyle& style, MapScratch& scratch,
              std::span<std::uint8_t> rgb);

}  // namespace talus
