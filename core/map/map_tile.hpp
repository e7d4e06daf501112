// The numbering of map tiles: 256 x 256 pixels, and zooms that each halve a pixel's edge. Pure.
//
// The world has no edge worth drawing, so tile (0, 0) begins at its origin and coordinates have signs; x grows with x,
// y with z. At the finest zoom a pixel is a voxel.
#pragma once

#include <cstdint>

#include "core/grid/chunk_key.hpp"
#include "core/map/map_view.hpp"

namespace talus {

inline constexpr int kMapTilePixels = 256;
/// Zooms are 0 (coarsest: a pixel is 2^11 voxels, a tile 524 km of metre-voxels) .. kMapZoomMax (a pixel is a voxel).
inline constexpr int kMapZoomMax = 11;

struct MapTile {
  std::int32_t zoom = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
};

/// Tile coordinates of `zoom` are -map_tile_limit .. map_tile_limit - 1: what chunks of LOD 0 reach.
constexpr std::int32_t map_tile_limit(int zoom, int cells) {
  const std::int64_t voxels = (std::int64_t{kChunkLimit} + 1) * cells;
  return static_cast<std::int32_t>((voxels / kMapTilePixels) >> (kMapZoomMax - zoom));
}

constexpr bool is_valid(const MapTile& tile, int cells) {
  if (tile.zoom < 0 || tile.zoom > kMapZoomMax) return false;
  const std::int32_t limit = map_tile_limit(tile.zoom, cells);
  const auto inside = [&](std::int32_t c) { return c >= -limit && c < limit; };
  return inside(tile.x) && inside(tile.y);
}

/// Requires a valid tile.
constexpr MapView map_view(const MapTile& tile) {
  MapView view;
  view.pixel_voxels = std::int64_t{1} << (kMapZoomMax - tile.zoom);
  view.samples = view.pixel_voxels > 1 ? 2 : 1;
  view.width = kMapTilePixels;
  view.height = kMapTilePixels;
  view.x_voxel = tile.x * view.pixel_voxels * kMapTilePixels;
  view.z_voxel = tile.y * view.pixel_voxels * kMapTilePixels;
  return view;
}

}  // namespace talus
