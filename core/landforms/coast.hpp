// Where land meets the sea: cliffs with headlands, stacks and buttresses on hilly coasts, beaches on gentle ones. Pure.
//
// A stage of the world function after erosion and ledges. It wrinkles the raw height near the sea (fins across the
// coast, joints in the rock) and then lifts what lies above the sea (core/landforms/cliff-inl.hpp). Where it lifts,
// and how far, is decided by the hinterland's slope and by districts. Shores of plains and of districts without cliffs
// get the profile of a beach: bar, face, berm, and the foot of the dunes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "core/grid/column_grid.hpp"

namespace talus {

/// The wall stands where the raw height is within these, in metres: its foot below the tide, its rim above.
inline constexpr float kCliffFoot_m = -1.0f;
inline constexpr float kCliffRim_m = 2.4f;
/// From the first to the second raw height the lift is worn off, in metres. The distance between them keeps heights in
/// order: the lift falls by at most 1.5 * kCliffMax_m / 380 m = 0.59 per metre.
inline constexpr float kCliffInland_m = 60.0f;
inline constexpr float kCliffReach_m = 440.0f;
/// A beach reaches from the first to the last of these raw heights, in metres: the sea's side of the bar, its crest,
/// the lower and the upper end of the beach's face, the berm, the foot of the dunes.
inline constexpr float kBar_m = -4.0f;
inline constexpr float kBarCrest_m = -2.4f;
inline constexpr float kFaceLow_m = -0.7f;
inline constexpr float kFaceHigh_m = 0.9f;
inline constexpr float kBerm_m = 3.3f;
inline constexpr float kDuneFoot_m = 5.6f;
/// Down to this depth the sea floor is raised, in metres.
inline constexpr float kShelfReach_m = 90.0f;
inline constexpr float kCliffMax_m = 150.0f;  ///< highest lift

/// The manifest's [coast] section says what each does.
struct CoastControls {
  double cliff_m = 52;
  double cliff_vary_m = 34;
  double cliff_share = 0.65;
  double cliff_slope = 0.07;
  double district_m = 4500;
  double fin_m = 11;
  double fin_wavelength_m = 64;
  double joint_m = 1.1;
  double shelf = 0.6;
  double beach = 1;
  std::uint64_t seed = 0;
};

/// What the stage reads, one array per quantity over a grid of columns: the relief before erosion.
struct CoastInput {
  std::span<const float> relief_x;  ///< its slope, unitless
  std::span<const float> relief_z;
  std::span<const float> hilliness;  ///< 0 (plain) .. 1 (range)
};

/// The surface, changed in place, and where it is a cliff.
struct CoastSurface {
  std::span<float> height_m;
  std::span<float> slope_x;
  std::span<float> slope_z;
  std::span<float> cliff_m;  ///< out: how far land is lifted here, 0 on coasts without cliffs
  std::span<float> beach;    ///< out: 0..1, whole from below the tide to the foot of the dunes on coasts with beaches
};

/// Arrays of sample_count(grid) floats that `coast` needs as workspace.
inline constexpr std::size_t kCoastArrays = 24;

/// Spans hold sample_count(grid) floats, `workspace` kCoastArrays times as many. Slopes leave out how the hinterland's
/// own slope and hilliness change: they are slow.
void coast(const CoastControls& controls, const ColumnGrid& grid, const CoastInput& input, const CoastSurface& surface,
           std::span<float> workspace);

/// Heights after the stage where those before it lie within `heights_m`.
glm::dvec2 coast_bound(const CoastControls& controls, glm::dvec2 heights_m);

}  // namespace talus
