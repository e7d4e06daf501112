#include "core/map/draw_map.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/check.hpp"

namespace talus {

std::optional<MapLayer> map_layer(std::string_view name) {
  const auto at = std::ranges::find(kMapLayerNames, name);
  if (at == kMapLayerNames.end()) return std::nullopt;
  return static_cast<MapLayer>(at - kMapLayerNames.begin());
}

namespace {

/// Pixels around a view that its light needs: 3 for the broad slope and 1 for its mean.
constexpr int kMargin = 4;
constexpr int kBroad = 3;

/// A lamp: where it stands (towards it, unit) and its light.
struct Lamp {
  glm::vec3 towards;
  glm::vec3 light;
};

/// Steepens slopes the more, the larger a pixel: a range seen from afar is a smooth hump. The exponent is a quarter.
float exaggeration(float pixel_m) {
  return std::clamp(1.15f * std::sqrt(std::sqrt(std::max(pixel_m, 1.0f) * 0.25f)), 1.0f, 4.0f);
}

class Light {
 public:
  explicit Light(const Ground& ground, double pixel_m)
      : ground_(ground), pixel_m_(static_cast<float>(pixel_m)), steeper_(exaggeration(pixel_m_)) {
    const glm::vec3 flat = lit({0.0f, 0.0f});
    flat_ = glm::vec3(1.0f) / flat;
  }

  /// What falls on a pixel, as a multiple of what falls on level ground. `strength` 0..1 weakens slopes.
  glm::vec3 on(std::size_t at, float strength) const {
    // The near slope shows gullies; a quarter of a broader one groups them into the flanks of their mountain.
    const glm::vec2 slope = near_slope(at) * 0.78f + broad_slope(at) * 0.34f;
    return lit(slope * (steeper_ * strength)) * flat_;
  }

 private:
  float h(std::size_t at) const { return ground_.height_m[at]; }

  /// Horn's weights over the eight neighbours (Horn, "Hill shading and the reflectance map", 1981).
  glm::vec2 near_slope(std::size_t at) const {
    const std::size_t s = ground_.stride;
    const float x = (h(at - s + 1) - h(at - s - 1)) + 2.0f * (h(at + 1) - h(at - 1)) + (h(at + s + 1) - h(at + s - 1));
    const float z = (h(at + s - 1) - h(at - s - 1)) + 2.0f * (h(at + s) - h(at - s)) + (h(at + s + 1) - h(at - s + 1));
    return glm::vec2(x, z) / (8.0f * pixel_m_);
  }

  float mean(std::size_t at) const {
    const std::size_t s = ground_.stride;
    return 0.25f * h(at) + 0.1875f * (h(at - 1) + h(at + 1) + h(at - s) + h(at + s));
  }
  glm::vec2 broad_slope(std::size_t at) const {
    const std::size_t far = kBroad * ground_.stride;
    return glm::vec2(mean(at + kBroad) - mean(at - kBroad), mean(at + far) - mean(at - far)) /
           (2.0f * kBroad * pixel_m_);
  }

  /// A warm lamp in the north-west, a cool one in the west-south-west, and a blue sky.
  static glm::vec3 lit(const glm::vec2& slope) {
    static const Lamp kSun{glm::normalize(glm::vec3(-1.0f, 1.15f, -1.0f)), {1.02f, 0.96f, 0.85f}};
    static const Lamp kFill{glm::normalize(glm::vec3(-1.0f, 0.9f, 0.55f)), {0.16f, 0.19f, 0.24f}};
    static const glm::vec3 kSky{0.17f, 0.21f, 0.29f};
    const glm::vec3 normal = glm::normalize(glm::vec3(-slope.x, 1.0f, -slope.y));
    const auto from = [&](const Lamp& lamp) { return lamp.light * std::max(0.0f, glm::dot(normal, lamp.towards)); };
    return from(kSun) + from(kFill) + kSky * (0.4f + 0.6f * normal.y);
  }

  const Ground& ground_;
  float pixel_m_;
  float steeper_;
  glm::vec3 flat_{1.0f};
};

/// How much light shows on a layer: figures are to be read, not admired.
float relief_of(MapLayer layer) {
  switch (layer) {
    case MapLayer::kShaded:
      return 1.0f;
    case MapLayer::kMaterial:
    case MapLayer::kLayer:
      return 0.5f;
    default:
      return 0.0f;
  }
}

/// Whether a contour line passes between a pixel and its right or lower neighbour.
bool on_contour(const Ground& g, std::size_t at, float interval_m) {
  const auto step = [&](std::size_t p) { return std::floor(g.height_m[p] / interval_m); };
  return step(at) != step(at + 1) || step(at) != step(at + g.stride);
}

/// Light above the knee is compressed, so that sunlit snow keeps its forms: slope 1 at the knee, 1 at infinity.
std::uint8_t encode(float light) {
  constexpr float kKnee = 0.72f;
  constexpr float kRoom = 1.0f - kKnee;
  const float over = std::max(0.0f, light - kKnee);
  const float shown = std::min(std::max(light, 0.0f), kKnee) + kRoom * over / (over + kRoom);
  return static_cast<std::uint8_t>(std::sqrt(shown) * 255.0f + 0.5f);
}

}  // namespace

void draw_map(const WorldFunction& world, const MapView& view, const MapStyle& style, MapScratch& scratch,
              std::span<std::uint8_t> rgb) {
  const auto width = static_cast<std::size_t>(view.width);
  TALUS_CHECK(rgb.size() >= 3 * width * static_cast<std::size_t>(view.height));
  gather_ground(world, view, style.layer, kMargin, scratch);
  const Ground& ground = scratch.ground;
  const Light light(ground, static_cast<double>(view.pixel_voxels) * world.voxel_m());
  const float relief = relief_of(style.layer);
  std::uint8_t* out = rgb.data();
  for (int k = 0; k < view.height; ++k) {
    const std::size_t row = static_cast<std::size_t>(k + kMargin) * ground.stride + kMargin;
    for (std::size_t at = row; at < row + width; ++at, out += 3) {
      glm::vec3 seen = ground.colour[at];
      if (relief > 0.0f) seen *= light.on(at, relief);
      if (const float wet = ground.wet[at]; wet > 0.0f) {
        // The floor shows through the water, less the deeper it lies.
        const float depth = std::max(0.0f, -ground.height_m[at]);
        const float clear = 0.55f / (1.0f + depth * 0.012f) + 0.12f;
        const glm::vec3 sea = sea_light(depth) * light.on(at, clear);
        seen = seen * (1.0f - wet) + sea * wet;
      }
      if (style.contour_m > 0 && on_contour(ground, at, static_cast<float>(style.contour_m))) seen *= 0.55f;
      for (int c = 0; c < 3; ++c) out[c] = encode(seen[c]);
    }
  }
}

}  // namespace talus
