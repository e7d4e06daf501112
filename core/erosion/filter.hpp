// The erosion filter: branching gullies and ridges laid over any height function, point by point. Pure.
//
// Problem: simulated water needs the whole landscape at once. Answer: stripes that run down the slope, whose sides give
// the slope for the next, finer stripes, each octave fading where the last has its ridges and creases. Based on: R.
// Johansen, "Fast and Gorgeous Erosion Filter", 2026 (fade method), after C. John, "Eroded Terrain Noise", 2018, and F.
// Westin, 2023; written from the article's description. What differs: strength and method vary per point; metres
// instead of tiles. The frequency method is frequency-inl.hpp.
#pragma once

#include <cstdint>
#include <span>

#include "core/grid/column_grid.hpp"

namespace talus {

inline constexpr int kErosionOctavesMax = 10;

/// Every control of both methods; the manifest's [erosion] section says what each does.
struct ErosionControls {
  double scale_m = 1000;
  int octaves = 7;  ///< 0..kErosionOctavesMax
  double strength = 0.19;
  double gain = 0.5;
  double lacunarity = 2;
  double gully_weight = 0.5;
  double detail = 1.8;
  double rounding_ridge = 0.05;
  double rounding_crease = 0.03;
  double rounding_input = 0.1;
  double rounding_octave = 2;
  double onset_input = 1.25;
  double onset_octave = 1.25;
  double ridge_onset_input = 2.8;
  double ridge_onset_octave = 1.5;
  double assumed_slope = 0.7;
  double assumed_blend = 1;
  double cell_scale = 0.7;
  double normalisation = 0.5;
  double offset = 0;
  double frequency_slope = 2.4;  ///< frequency method: stripes per scale on a slope of 1
  double frequency_max = 1.6;    ///< stripes per scale that no slope passes, > 0
  double frequency_branch = 1;   ///< how far the sides of gullies turn finer ones
  double frequency_pull = 0.8;   ///< share of the strength that parts peaks from valleys; 0 is the original
  double frequency_valley = 1;   ///< share of the gullies that give out towards valley floors; 0 is the original
  std::uint64_t seed = 0;
};

/// What the filter reads, one array per quantity over a grid of columns.
struct ErosionInput {
  std::span<const float> slope_x;  ///< d height / dx, unitless
  std::span<const float> slope_z;
  std::span<const float> fade_target;  ///< -1 valley .. +1 peak, clamped by the filter
  std::span<const float> strength;     ///< share of controls.strength at this point, >= 0
  /// Share of the frequency method, 0..1; the rest is the fade method's. Empty means 0 everywhere. A method costs only
  /// where some point of a vector has a share of it, and neither does where the strength is 0.
  std::span<const float> frequency_share = {};
};

/// What it adds. May not overlap the input.
struct ErosionOutput {
  std::span<float> height_m;  ///< change of height
  std::span<float> slope_x;   ///< approximate change of slope: fit for shading decisions, not for normals
  std::span<float> slope_z;
  std::span<float> ridge;  ///< ridge map, -1 (crease) .. +1 (ridge)
  /// How far fine gullies cut below their own crests, in metres (>= 0), and the slope of that: what rock that
  /// withstands them keeps. Peaks and valley floors have none. Gullies up to kFineFull_m wide count fully, those from
  /// kFineNone_m on not at all. All three may be empty.
  std::span<float> cut_m = {};
  std::span<float> cut_x = {};
  std::span<float> cut_z = {};
};

inline constexpr double kFineFull_m = 160;
inline constexpr double kFineNone_m = 420;

/// Spans hold sample_count(grid) floats. Where the strength is 0 everything is 0. With 0 octaves everything is 0 but
/// the ridge map, which is the masked fade target.
void erode(const ErosionControls& controls, const ColumnGrid& grid, const ErosionInput& input,
           const ErosionOutput& output);

/// |change of height|, and what fine gullies cut, stay below this times the largest strength of the input, in metres.
double erosion_bound(const ErosionControls& controls);

}  // namespace talus
