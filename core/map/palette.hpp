// Colours of maps. Pure.
//
// Colours are mixed and lit in squares of their sRGB values: near enough to light, and exact on every processor, which
// the true curve's powers would not be.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "core/world/world_function.hpp"

namespace talus {

/// One stop of a ramp: `at` rises from stop to stop.
struct ColourStop {
  float at;
  glm::vec3 light;
};

/// sRGB 0xRRGGBB as light.
constexpr glm::vec3 light_of(std::uint32_t rgb) {
  const auto channel = [&](int shift) {
    const float v = static_cast<float>(rgb >> shift & 0xFFU) / 255.0f;
    return v * v;
  };
  return {channel(16), channel(8), channel(0)};
}

/// `a` at t = 0, `b` at 1, and beyond either end as there.
glm::vec3 mix(const glm::vec3& a, const glm::vec3& b, float t);

/// Linear between stops, constant beyond the ends. Requires at least one stop.
glm::vec3 ramp(std::span<const ColourStop> stops, float at);

glm::vec3 sea_light(float depth_m);
glm::vec3 heat_light(float share);  ///< dark to bright, 0..1
/// A plate's colour by its kind, shaded by any number of its own so that neighbours differ.
glm::vec3 plate_light(PlateKind kind, std::uint64_t number);
glm::vec3 fault_light(FaultClass fault);
glm::vec3 district_light(District district);
/// Any number has one of many colours that are told apart easily.
glm::vec3 category_light(std::uint64_t number);

/// Colours of land by height: meadows, barren slopes, rock, with the lines at which a world's covers change.
class LandPalette {
 public:
  explicit LandPalette(const Manifest& manifest);
  glm::vec3 tint(float height_m) const { return ramp(stops_, height_m); }
  /// The tint, paler where the land is dry (0..1), with as much of the material's own colour as that material is worth
  /// on a map.
  glm::vec3 land(float height_m, Material material, float dryness) const;

 private:
  std::array<ColourStop, 8> stops_;
};

}  // namespace talus
