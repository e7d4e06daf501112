// Districts as the world function meets them: which stage of a column's making they change, and how. Private to
// core/world; pure.
#pragma once

#include <span>

#include "core/landforms/district.hpp"
#include "core/world/arrays.hpp"
#include "core/world/terms.hpp"

namespace talus {

/// Districts of one grid of columns, and what they hand from stage to stage.
struct DistrictStages {
  /// Takes the arrays that live from stage to stage, and the weights' from `out`.
  DistrictStages(Arrays& arrays, const ColumnGrid& grid, ColumnBlock& out);

  DistrictWeights weights;
  JetArrays rills;                 ///< fade target of rills, and in badlands the slopes they run down
  std::span<float> rill_strength;  ///< where rills run at all
  bool any_rills = false;
  std::span<float> shore_x;  ///< slope of the relief as cliffs of the coast see it: none in districts of lowlands
  std::span<float> shore_z;
};

/// Arrays that districts take for good, and the most they borrow for a while.
inline constexpr std::size_t kDistrictStageArrays = 2 * kDistricts + 7;
inline constexpr std::size_t kDistrictBorrowed = kDistrictArrays;

/// After the relief: weights, and the raw shapes of badlands, tables and karst. `fade` is
/// the relief's own fade target.
void raise_landforms(const WorldFunction::Terms& terms, const GroundArrays& ground, std::span<const float> hilliness,
                     std::span<const float> fade, const ColumnGrid& grid, const Arrays& arrays, DistrictStages& stages);

/// After the layers' place is known: lays them flatter under table land and badlands, and cuts table land into
/// terraces.
void lay_tables(const WorldFunction::Terms& terms, const DistrictStages& stages, const GroundArrays& ground,
                ColumnBlock& out);

/// Before erosion: how much is left to the large gullies, how much goes to rills, and the share of the frequency method
/// (all of it under glaciers).
void share_erosion(float frequency_everywhere, DistrictStages& stages, std::span<float> strength,
                   std::span<float> frequency_share);

/// What erosion changes: the ground, and how much of that fine gullies have cut.
struct ErodedArrays {
  GroundArrays change, cut;
};

/// After erosion: rills on top of `eroded`, and of the ridge map.
void add_rills(const WorldFunction::Terms& terms, const DistrictStages& stages, const GroundArrays& relief,
               const ErodedArrays& eroded, const Arrays& arrays, ColumnBlock& out);

/// Before ledges: where districts show them whatever `shown`, the noise of ledges, says.
void show_ledges(const DistrictStages& stages, std::span<float> shown);

}  // namespace talus
