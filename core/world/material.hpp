// What a surface is made of. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace talus {

/// Index into kMaterials; the number that travels with every vertex.
enum class Material : std::uint8_t { kRock, kScree, kSoil, kGrass, kSand, kSnow, kStreamBed };

struct MaterialInfo {
  std::string_view name;
  std::uint32_t colour_rgb;  ///< 0xRRGGBB, sRGB
  double erodibility;        ///< 0 (never worn) .. 1 (washed away first)
};

inline constexpr std::array<MaterialInfo, 7> kMaterials{{
    {"rock", 0x8A8178, 0.30},
    {"scree", 0x9C9286, 0.70},
    {"soil", 0x7B6547, 0.85},
    {"grass", 0x66803F, 0.75},
    {"sand", 0xCDBB8C, 0.95},
    {"snow", 0xF2F5F8, 0.50},
    {"stream_bed", 0x6E6A62, 0.80},
}};

}  // namespace talus
