// Volcanoes, cinder cones, seamounts and guyots: cones that stand in the cells of a hashed lattice. Pure.
//
// Problem: noise makes lumps, never a mountain that knows where its summit is. Answer: a cell of the lattice hashes to
// at most one cone, with its place, size and children on its flanks; a grid gathers the cells within reach, so far
// columns cost nothing. Volcanoes and seamounts join the relief before erosion, which then cuts their flanks into
// radial gullies; cinder cones come after it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/column_grid.hpp"

namespace talus {

/// The manifest's [cones] section says what each does.
struct ConeControls {
  double cell_m = 8000;
  double land_share = 0.22;
  double sea_share = 0.5;
  double volcano_m = 850;
  double seamount_m = 288;
  double cinder_m = 75;
  std::uint64_t seed = 0;
};

/// One cone. Its centre lies on whole multiples of 4 m, so that it is a column of every world's lattice.
struct Cone {
  double x_m = 0;
  double z_m = 0;
  float radius_m = 0;      ///< of the foot, on average; it sways by noise up to a third
  float height_m = 0;      ///< of the summit that the crater or the plateau cuts off
  float crater = 0;        ///< radius of the crater's rim over the foot's, 0 without one
  float crater_m = 0;      ///< depth of the crater below its rim
  float flat = 1;          ///< share of the height at which a guyot's plateau lies; 1 without one
  float gullies = 0;       ///< erosion strength of the flanks, 0..1
  bool is_cinder = false;  ///< a heap of cinders, on a flank or in a field
};
/// Around its foot, up to this many radii, a volcano keeps valleys from forming.
inline constexpr float kConeCalm = 1.3f;
/// No column further from a cone's centre than this many radii feels it: kConeCalm / (1 - 0.1 * the noise's bound of
/// 2.4), rounded up.
inline constexpr double kConeReach = 1.72;

/// Where a cell's cone would stand, before it is known on what.
struct ConeSite {
  double x_m = 0;
  double z_m = 0;
  std::uint64_t hash = 0;
  double scale = 1;  ///< of the chance that it holds a cone
};
/// Sites whose cone could reach a column of `grid`, in the order of their cells; `out` is emptied first.
void find_cone_sites(const ConeControls& controls, const ColumnGrid& grid, std::vector<ConeSite>& out);

/// Appends the cone of a site and its children, or nothing, given the relief there: a seamount or guyot on the sea
/// floor; a volcano or a field of cinder cones on land, volcanoes the likelier the hillier.
void grow_cones(const ConeControls& controls, const ConeSite& site, float ground_m, float hilliness,
                std::vector<Cone>& out);

/// The surface, changed in place over a grid of columns.
struct ConeSurface {
  std::span<float> height_m, slope_x, slope_z;
};
/// What erosion is to do with it.
struct ConeErosion {
  std::span<float> fade_target, strength, hilliness;
};
/// Arrays of sample_count(grid) floats that `raise_cones` and `heap_cinders` need as workspace.
inline constexpr std::size_t kConeArrays = 10;

/// Puts volcanoes and seamounts on the relief before erosion. Spans hold sample_count(grid) floats, `workspace`
/// kConeArrays times as many. The result at a column does not depend on cones that do not reach it.
void raise_cones(const ConeControls& controls, std::span<const Cone> cones, const ColumnGrid& grid,
                 const ConeSurface& relief, const ConeErosion& erosion, std::span<float> workspace);

/// Puts the cinder cones on the eroded surface: they are younger than its gullies, and smaller.
void heap_cinders(const ConeControls& controls, std::span<const Cone> cones, const ColumnGrid& grid,
                  const ConeSurface& surface, std::span<float> workspace);

/// Both together raise a column by at most this, in metres, and lower it nowhere.
double cones_bound(const ConeControls& controls);

}  // namespace talus
