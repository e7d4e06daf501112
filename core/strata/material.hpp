// What a surface is made of: covers that lie on the ground, and rocks that layers are made of. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace talus {

/// Index into kMaterials; the number that travels with every vertex. Covers first, then rocks.
enum class Material : std::uint8_t {
  kRock,
  kScree,
  kSoil,
  kGrass,
  kSand,
  kSnow,
  kStreamBed,
  kLimestone,
  kSandstone,
  kRedSandstone,
  kMudstone,
  kShale,
  kMarl,
  kBasalt,
  kGranite,
  kDolomite,
  kChalk,
  kSiltstone,
  kConglomerate,
  kGneiss,
  kSchist,
  kTuff
};

struct MaterialInfo {
  std::string_view name;
  std::uint32_t colour_rgb;  ///< 0xRRGGBB, sRGB
  double erodibility;        ///< 0 (never worn) .. 1 (washed away first); 1 - hardness for rocks
};

/// Colours of rocks lie close together: strong contrasts look like stripes of paint.
inline constexpr std::array<MaterialInfo, 22> kMaterials{{
    {"rock", 0x8A8178, 0.30},          {"scree", 0x9C9286, 0.70},     {"soil", 0x7B6547, 0.85},
    {"grass", 0x66803F, 0.75},         {"sand", 0xCDBB8C, 0.95},      {"snow", 0xF2F5F8, 0.50},
    {"stream_bed", 0x6E6A62, 0.80},    {"limestone", 0xA69C8A, 0.18}, {"sandstone", 0xA98F6D, 0.30},
    {"red_sandstone", 0x9A6A50, 0.38}, {"mudstone", 0x7E6A5C, 0.85},  {"shale", 0x6F6A66, 0.80},
    {"marl", 0x938C7C, 0.65},          {"basalt", 0x5B5752, 0.10},    {"granite", 0x958B84, 0.08},
    {"dolomite", 0xADA08A, 0.14},      {"chalk", 0xB9B2A2, 0.42},     {"siltstone", 0x8C7A68, 0.62},
    {"conglomerate", 0x977E66, 0.32},  {"gneiss", 0x87807C, 0.09},    {"schist", 0x75726E, 0.38},
    {"tuff", 0x8A7C72, 0.58},
}};

/// Covers are those below this one.
inline constexpr Material kFirstLayerRock = Material::kLimestone;

constexpr const MaterialInfo& info_of(Material material) {
  return kMaterials[static_cast<std::size_t>(material)];
}
constexpr float hardness_of(Material material) {
  return static_cast<float>(1.0 - info_of(material).erodibility);
}

}  // namespace talus
