// Districts: where the land is badlands, dunes, table land, karst, or was under glaciers, and how much. Pure.
//
// Problem: plain lowlands are plain, and ranges are all of one kind. Answer: two slow noises whose extremes are
// districts, each with a share of the world and a soft border, where the ground suits it; every landform is scaled by
// its district's weight, and costs nothing where that is 0 everywhere.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/grid/column_grid.hpp"

namespace talus {

/// Kinds of district, index into DistrictWeights.
enum class District : std::uint8_t { kBadlands, kDunes, kMesas, kKarst, kGlacial };
inline constexpr std::size_t kDistricts = 5;
inline constexpr std::array<std::string_view, kDistricts> kDistrictNames{"badlands", "dunes", "mesas", "karst",
                                                                         "glacial"};

/// The manifest's [districts] section says what each does.
struct DistrictControls {
  double wavelength_m = 15000;
  double border = 0.09;                                               ///< half width, in units of the noise
  std::array<double, kDistricts> share{0.15, 0.12, 0.15, 0.12, 0.4};  ///< of the ground that suits each, 0..0.45
  std::uint64_t seed = 0;
};

/// Height and slopes of the ground over a grid, changed in place by landforms.
struct GroundArrays {
  std::span<float> height_m;
  std::span<float> slope_x;  ///< d height / dx
  std::span<float> slope_z;
};

/// A quantity over a grid with its slopes per metre.
struct JetArrays {
  std::span<float> v;
  std::span<float> x;
  std::span<float> z;
};

/// Weights of every district, 0..1, at most 1 together; and which have any weight in the grid at all.
struct DistrictWeights {
  std::array<JetArrays, kDistricts> of;
  std::array<bool, kDistricts> present{};
  /// Share of their folds and tilt that rock layers keep, 0..1: less in and around badlands and table land, whatever
  /// the ground, so that no layer bends where only the ground ends.
  std::span<float> folded;

  const JetArrays& operator[](District district) const { return of[static_cast<std::size_t>(district)]; }
  bool has(District district) const { return present[static_cast<std::size_t>(district)]; }
};

/// Arrays of sample_count(grid) floats that district_weights needs as workspace.
inline constexpr std::size_t kDistrictArrays = 9;

/// Fills weights.of, whose spans hold sample_count(grid) floats, and weights.present. `ground` is the relief before
/// erosion, `hilliness` 0 (plain) .. 1 (range), so slow that weights leave its slope out.
void district_weights(const DistrictControls& controls, const ColumnGrid& grid, const GroundArrays& ground,
                      std::span<const float> hilliness, std::span<float> workspace, DistrictWeights& weights);

/// The value that the district noises exceed on the share `share` of a large area, 0 < share < 1.
double district_threshold(double share);

}  // namespace talus
