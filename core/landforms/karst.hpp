// Karst: cones and towers of limestone, and the sinkholes between them. Pure.
//
// One point per cell of a jittered lattice is a tower, a sinkhole or nothing. Towers add up smoothly, so that
// neighbours grow together to ridges, and a steep step of the sum makes their walls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "core/grid/column_grid.hpp"
#include "core/landforms/district.hpp"

namespace talus {

/// The manifest's [districts] section says what each does.
struct KarstControls {
  double height_m = 130;
  double cell_m = 240;
  double share = 0.6;  ///< of cells that hold a tower; 0.2 of them hold a sinkhole
  double sink_m = 16;
  std::uint64_t seed = 0;
};

/// Arrays of sample_count(grid) floats that `karst` needs as workspace.
inline constexpr std::size_t kKarstArrays = 3;

/// Adds towers and sinkholes where the district has weight. GroundArrays without weight keeps its bits.
void karst(const KarstControls& controls, const ColumnGrid& grid, const JetArrays& weight, const GroundArrays& ground,
           std::span<float> workspace);

/// Heights after the stage where those before it lie within `heights_m`.
glm::dvec2 karst_bound(const KarstControls& controls, glm::dvec2 heights_m);

}  // namespace talus
