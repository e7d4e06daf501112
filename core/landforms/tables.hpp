// Hills of badlands and the tables and canyons of table land: raw shapes that finer erosion and terraces finish. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "core/grid/column_grid.hpp"
#include "core/landforms/district.hpp"

namespace talus {

/// The manifest's [districts] section says what each does.
struct BadlandsControls {
  double hill_m = 120;
  double wavelength_m = 1000;
  std::uint64_t seed = 0;
};

struct MesaControls {
  double height_m = 220;
  double wavelength_m = 2800;
  double canyon_width = 0.2;  ///< of the canyons' noise
  std::uint64_t seed = 0;
};

/// Arrays of sample_count(grid) floats that `badlands` and `mesas` need as workspace.
inline constexpr std::size_t kBadlandsArrays = 3;
inline constexpr std::size_t kMesaArrays = 6;

/// Adds low hills where the district has weight; elsewhere the ground keeps its bits. `rills` takes what finer erosion
/// is to see: its fade target (v, by weight) and the slopes it runs down, those of the hills rather than of the country
/// under them, which would comb it all one way. Slopes are written where the district has weight only.
void badlands(const BadlandsControls& controls, const ColumnGrid& grid, const JetArrays& weight,
              const GroundArrays& ground, const JetArrays& rills, std::span<float> workspace);

/// Adds tables, the slopes around them and the canyons through them. Ground without weight keeps its bits.
void mesas(const MesaControls& controls, const ColumnGrid& grid, const JetArrays& weight, const GroundArrays& ground,
           std::span<float> workspace);

/// Heights after each where those before it lie within `heights_m`.
glm::dvec2 badlands_bound(const BadlandsControls& controls, glm::dvec2 heights_m);
glm::dvec2 mesas_bound(const MesaControls& controls, glm::dvec2 heights_m);

}  // namespace talus
