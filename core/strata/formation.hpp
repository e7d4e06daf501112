// Formations: groups of layers of one character, and what rocks their layers hold. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/strata/material.hpp"

namespace talus {

/// Different rocks that one layer can hold in different places.
inline constexpr std::size_t kRocksPerLayer = 3;

/// A rock and how often a layer holds it; shares of one mixture sum up to 1, and unused places have a share of 0.
struct RockShare {
  Material rock;
  float share;
};
using Mixture = std::array<RockShare, kRocksPerLayer>;

struct Formation {
  Mixture beds, partings;  ///< hard layers, and the soft ones between them
  float bed_low_m, bed_high_m;
  float parting_low_m, parting_high_m;
  float whole_low_m, whole_high_m;  ///< thickness of the formation
};

/// Every kind of formation there is.
std::span<const Formation> formations();

}  // namespace talus
