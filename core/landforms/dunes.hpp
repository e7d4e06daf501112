// Dunes: sand in asymmetric waves across a wind that turns slowly from place to place. Pure.
//
// Stripes of phacelle noise along the crests fork and end as those of dunes do; their phase is bent so that the lee
// side is steeper than the windward one, and the crest is drawn to an edge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "core/grid/column_grid.hpp"
#include "core/landforms/district.hpp"

namespace talus {

/// The manifest's [districts] section says what each does.
struct DuneControls {
  double height_m = 22;
  double wavelength_m = 260;
  double skew = 0.55;  ///< 0 (lee and windward sides alike) .. 0.9
  double wind_m = 24000;
  std::uint64_t seed = 0;
};

/// Arrays of sample_count(grid) floats that `dunes` needs as workspace.
inline constexpr std::size_t kDuneArrays = 6;

/// Adds dunes where the district has weight. Slopes take the stripes' direction for constant across one wave.
/// GroundArrays without weight keeps its bits.
void dunes(const DuneControls& controls, const ColumnGrid& grid, const JetArrays& weight, const GroundArrays& ground,
           std::span<float> workspace);

/// Heights after the stage where those before it lie within `heights_m`.
glm::dvec2 dunes_bound(const DuneControls& controls, glm::dvec2 heights_m);

}  // namespace talus
