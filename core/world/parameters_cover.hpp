// Parameters of a world: what lies underfoot. Name, unit, limits, default, whole numbers only, meaning.
#pragma once

#include <array>

#include "core/world/manifest.hpp"

namespace talus {

// clang-format off
inline constexpr std::array kCoverParameters = std::to_array<ParameterInfo>({
  {"micro.wavelength_m", "m", 5, 500, 60, false, "Largest wavelength of the roughness on top: more means larger lumps."},
  {"micro.octaves", "", 0, 6, 4, true, "Octaves of roughness: more means detail down to the voxel."},
  {"micro.base_m", "m", 0, 5, 0.4, false, "Amplitude of roughness on plains: more means bumpier meadows."},
  {"micro.hill_m", "m", 0, 10, 2.4, false, "Amplitude of roughness added where hilliness is 1: more means rougher ground away from scree and beaches."},

  {"detail.joint_m", "m", 0, 2, 1, false, "Depth of the joints that cut steep rock: more means more broken walls, 0 smooth ones."},
  {"detail.boulder_m", "m", 4, 40, 9, false, "Edge of the cells that hold a boulder each: more means larger ones, further apart."},
  {"detail.boulder_share", "", 0, 1, 0.35, false, "Share of those cells with a boulder on scree, in streams and below sea cliffs: more means denser fields, 0 none."},

  {"cover.snow_line_m", "m", -500, 5000, 1050, false, "Height above which snow lies on gentle ground: less means whiter mountains."},
  {"cover.grass_line_m", "m", -500, 5000, 850, false, "Height up to which grass grows: less means barer mountains."},
  {"cover.beach_m", "m", 0, 50, 4, false, "Height up to which gentle shores are sand: more means wider beaches."},
  {"cover.rock_slope", "", 0.1, 4, 1.1, false, "Slope (tangent) from which rock is bare: less means barer flanks."},
});
// clang-format on

}  // namespace talus
