// What a map shows and how: its pixels, its layer, its options. Pure data.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace talus {

/// A rectangle of square pixels over the world; x grows to the right, z downwards. Pixel (i, k) covers the voxels from
/// (x_voxel + i * pixel_voxels, z_voxel + k * pixel_voxels), so equal pixels have equal colours in every view.
struct MapView {
  std::int64_t x_voxel = 0;  ///< of the upper left corner
  std::int64_t z_voxel = 0;
  std::int64_t pixel_voxels = 1;  ///< edge of a pixel, a power of two
  int samples = 1;                ///< columns along a pixel's edge that are averaged: 1, 2 or 4; <= pixel_voxels
  int width = 0;                  ///< pixels
  int height = 0;
};

enum class MapLayer : std::uint8_t {
  kShaded,
  kHeight,
  kSlope,
  kMaterial,
  kLayer,
  kRidge,
  kHilliness,
  kPlates,
  kFaults,
  kDistrictWeights
};

/// The word of every layer, by its number.
inline constexpr std::array<std::string_view, 10> kMapLayerNames{
    "shaded", "height", "slope", "materials", "layers", "ridge", "hilliness", "plates", "faults", "districts"};

struct MapStyle {
  MapLayer layer = MapLayer::kShaded;
  double contour_m = 0;  ///< height between contour lines; 0: none
};

/// The layer called `name`.
std::optional<MapLayer> map_layer(std::string_view name);

}  // namespace talus
