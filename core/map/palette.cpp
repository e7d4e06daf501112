#include "core/map/palette.hpp"

#include <algorithm>
#include <array>

#include "core/base/check.hpp"
#include "core/base/hash.hpp"

namespace talus {
namespace {

constexpr std::array kSea{
    ColourStop{0.0f, light_of(0x8CC4CC)},    ColourStop{6.0f, light_of(0x6DB0C6)},
    ColourStop{40.0f, light_of(0x4288B2)},   ColourStop{130.0f, light_of(0x2A6299)},
    ColourStop{300.0f, light_of(0x1C477F)},  ColourStop{650.0f, light_of(0x133366)},
    ColourStop{2000.0f, light_of(0x0B2049)},
};

constexpr std::array kHeat{
    ColourStop{0.0f, light_of(0x0B0724)},  ColourStop{0.25f, light_of(0x57106E)}, ColourStop{0.5f, light_of(0xBC3754)},
    ColourStop{0.75f, light_of(0xF98C0A)}, ColourStop{1.0f, light_of(0xFCFFA4)},
};

/// Dust and bleached grass, where it hardly rains.
constexpr glm::vec3 kDryGround = light_of(0xB7A070);

/// How much of a material's own colour shows against the tint of its height.
float weight_of(Material material) {
  switch (material) {
    case Material::kSnow:
      return 1.0f;
    case Material::kSand:
      return 0.8f;
    case Material::kGrass:
      return 0.3f;
    case Material::kSoil:
    case Material::kStreamBed:
      return 0.45f;
    case Material::kScree:
      return 0.6f;
    default:
      return 0.75f;
  }
}

}  // namespace

glm::vec3 mix(const glm::vec3& a, const glm::vec3& b, float t) {
  return a + (b - a) * std::clamp(t, 0.0f, 1.0f);
}

glm::vec3 ramp(std::span<const ColourStop> stops, float at) {
  TALUS_CHECK(!stops.empty());
  const auto above = std::ranges::upper_bound(stops, at, {}, &ColourStop::at);
  if (above == stops.begin()) return stops.front().light;
  if (above == stops.end()) return stops.back().light;
  const ColourStop& low = *(above - 1);
  return mix(low.light, above->light, (at - low.at) / (above->at - low.at));
}

glm::vec3 sea_light(float depth_m) {
  return ramp(kSea, depth_m);
}

glm::vec3 heat_light(float share) {
  return ramp(kHeat, share);
}

glm::vec3 plate_light(PlateKind kind, std::uint64_t number) {
  const float shade = 0.55f + 0.75f * static_cast<float>(mix64(0x9B, number) >> 40) * 0x1p-24f;
  return shade * (kind == PlateKind::kContinental ? light_of(0x9C9A54) : light_of(0x2F5E94));
}

glm::vec3 fault_light(FaultClass fault) {
  // In the order of the classes: red closes, violet dives, cyan and orange part, the quiet ones are pale.
  static constexpr std::array kColours{light_of(0xE0402A), light_of(0xB030C8), light_of(0xE860A8), light_of(0x38C8D8),
                                       light_of(0xF8A020), light_of(0xC8C090), light_of(0x7FA8C8), light_of(0xE8E8C0)};
  return kColours[static_cast<std::size_t>(fault)];
}

glm::vec3 district_light(District district) {
  // Badlands red, dunes yellow, table land orange, karst green, ice blue.
  static constexpr std::array<glm::vec3, kDistricts> kColours{
      light_of(0xB8483C), light_of(0xF0D878), light_of(0xE08A3C), light_of(0x58A858), light_of(0x8CC8F0)};
  return kColours[static_cast<std::size_t>(district)];
}

glm::vec3 category_light(std::uint64_t number) {
  const std::uint64_t bits = mix64(0x7A1, number);
  const auto channel = [&](int shift) {
    const float v = 0.25f + 0.7f * static_cast<float>(bits >> shift & 0xFFU) / 255.0f;
    return v * v;
  };
  return {channel(0), channel(8), channel(16)};
}

LandPalette::LandPalette(const Manifest& manifest) {
  // The lines are free parameters; the ramp needs them in order and apart.
  const float grass_m = std::clamp(static_cast<float>(parameter(manifest, "cover.grass_line_m")), 100.0f, 4000.0f);
  const float snow_m = std::max(static_cast<float>(parameter(manifest, "cover.snow_line_m")), grass_m * 1.15f);
  stops_ = {ColourStop{0.0f, light_of(0xB9B487)},
            ColourStop{5.0f, light_of(0x93A765)},
            ColourStop{40.0f, light_of(0x6F9A50)},
            ColourStop{grass_m * 0.35f + 20.0f, light_of(0x7FA056)},
            ColourStop{grass_m * 0.75f, light_of(0xA9A868)},
            ColourStop{grass_m, light_of(0xA98F65)},
            ColourStop{0.5f * (grass_m + snow_m), light_of(0x8F7A64)},
            ColourStop{snow_m * 1.3f, light_of(0xA39A94)}};
}

glm::vec3 LandPalette::land(float height_m, Material material, float dryness) const {
  const glm::vec3 ground = mix(tint(height_m), kDryGround, 0.7f * dryness);
  return mix(ground, light_of(info_of(material).colour_rgb), weight_of(material));
}

}  // namespace talus
