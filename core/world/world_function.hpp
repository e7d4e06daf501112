// The world as a pure function of a manifest and a point.
//
// Owns nothing that changes: one object is shared by every thread. Columns are evaluated in whole rows so that SIMD
// lanes are full; the value at a lattice point does not depend on the rows, chunk, LOD, thread or processor it was
// asked from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/grid/chunk_key.hpp"
#include "core/grid/column_grid.hpp"
#include "core/landforms/cones.hpp"
#include "core/landforms/district.hpp"
#include "core/plates/macro_field.hpp"
#include "core/plates/plate_place.hpp"
#include "core/strata/material.hpp"
#include "core/strata/strata.hpp"
#include "core/volume/carve_spheres.hpp"
#include "core/world/manifest.hpp"

namespace talus {

/// Weight of every district at a column, by District.
using DistrictShares = std::array<float, kDistricts>;

/// Working memory of a block: the kernels' intermediate arrays, plates made lately, cones around. It is no part of a
/// block's value: a copy starts empty, and assigning leaves it as it is.
struct ColumnWorkspace {
  std::vector<float> arrays;
  MacroScratch macro;
  std::vector<ConeSite> cone_sites;
  std::vector<Cone> cones;

  ColumnWorkspace() = default;
  ColumnWorkspace(const ColumnWorkspace& /*other*/) {}
  ColumnWorkspace& operator=(const ColumnWorkspace& /*other*/) { return *this; }
  ColumnWorkspace(ColumnWorkspace&&) = default;
  ColumnWorkspace& operator=(ColumnWorkspace&&) = default;
  ~ColumnWorkspace() = default;
};

/// Values of a grid of columns, one array per quantity; column (i, k) is at k * stride + i. `stride` is a multiple of
/// 16 floats.
struct ColumnBlock {
  ColumnGrid grid;
  std::size_t stride = 0;
  std::vector<float> height_m;  ///< the surface, above sea level
  std::vector<float> slope_x;   ///< d height / d x of the relief, unitless; approximate inside gullies
  std::vector<float> slope_z;
  std::vector<float> steepness;  ///< 1 / sqrt(1 + slope^2): turns a vertical distance to the surface into a distance
  std::vector<float> ridge;      ///< ridge map, -1 (crease) .. +1 (ridge)
  std::vector<float> hilliness;  ///< 0 (plain) .. 1 (range)
  std::vector<float> stack_m;    ///< height of the top of the rock layers
  std::vector<float> choice;     ///< layer set, with the fraction over which the next one takes over
  std::vector<float> cliff_m;    ///< height of the sea cliff that stands here or nearby, 0 on other coasts and inland
  std::vector<float> beach;      ///< 1 on a beach, falling to 0 inland, in deeper water and on other coasts
  std::array<std::vector<float>, kDistricts> district;  ///< weight of every district, 0..1
  float height_low_m = 0;                               ///< over the whole block
  float height_high_m = 0;

  // What `volume` adds.
  bool has_volume = false;
  bool has_jut = false;
  std::vector<float> jut_m;          ///< metres by which the hardest beds raise the surface; unset unless has_jut
  std::vector<CarveSphere> spheres;  ///< all that samples over these columns can feel
  float rock_below_m = 0;            ///< everything in these columns below is rock
  float air_above_m = 0;             ///< everything in them at or above is air

  ColumnWorkspace workspace;

  DistrictShares districts_at(std::size_t index) const;
};

/// The highest that rock can stand in column `at` of a block, in metres: what the sky sees.
inline float top_m(const ColumnBlock& block, std::size_t at) {
  return block.height_m[at] + (block.has_volume && block.has_jut ? block.jut_m[at] : 0.0f);
}
/// Deeper below its column's top than this a point is in a cave, under an overhang or under an arch, in metres: what
/// lies under the open sky does not lie there.
inline constexpr float kUnderRoof_m = 2.5f;

/// What decides the cover of a place on the surface.
struct CoverPlace {
  float height_m = 0;
  float up = 1;  ///< y component of the surface's unit normal
  float ridge = 0;
  float hilliness = 0;
  float beach = 0;
  glm::i64vec2 column_voxel{0, 0};
  DistrictShares districts{};
  std::int64_t step_voxel = 1;  ///< of the lattice that asks
};

/// A point in rock.
struct RockPlace {
  float stack_m = 0;  ///< of its column
  float choice = 0;   ///< the same
  float height_m = 0;
  glm::i64vec2 column_voxel{0, 0};
  std::int64_t step_voxel = 1;  ///< of the lattice that asks: a wide cell shows what most of it is made of
};

/// Working memory of one thread for warp and carving (core/world/volume_scratch.hpp).
struct VolumeScratch;

class WorldFunction {
 public:
  /// Requires manifest_faults(manifest) to be empty.
  explicit WorldFunction(Manifest manifest);
  ~WorldFunction();
  WorldFunction(const WorldFunction&) = delete;
  WorldFunction& operator=(const WorldFunction&) = delete;

  const Manifest& manifest() const;
  int cells() const;       ///< per chunk edge
  double voxel_m() const;  ///< metres per voxel, a power of two
  /// No surface lies outside this interval of heights, in metres, anywhere in the world.
  glm::dvec2 height_range_m() const;

  /// Fills `out` for `grid`, reusing its memory. Two calls that cover the same lattice point give it the same bits.
  void columns(const ColumnGrid& grid, ColumnBlock& out) const;

  /// The plate under a point, in metres from the origin, and the fault next to it.
  PlatePlace plate_at(const glm::dvec2& place_m, ColumnWorkspace& workspace) const;

  /// Completes `block`, filled by columns(): how far beds jut out of its columns and what is carved out of them. After
  /// this its densities can be sampled.
  void volume(ColumnBlock& block, VolumeScratch& scratch) const;

  /// What covers the ground; kRock where it is bare.
  Material cover(const CoverPlace& place) const;
  /// What covers the ground where rock hangs over it.
  Material sheltered(float height_m, float up) const;
  /// The rock of the layer at a point.
  Material rock(const RockPlace& place) const;
  /// That layer.
  LayerPlace layer(const RockPlace& place) const;

  struct Terms;  ///< the manifest as the kernels want it (core/world/terms.hpp)
  const Terms& terms() const { return *terms_; }

 private:
  std::unique_ptr<const Terms> terms_;
};

}  // namespace talus
