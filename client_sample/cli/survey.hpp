// Figures of a world: what a square of it is made of, and places in it that are worth a visit. Deterministic.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "client_sample/cli/map_picture.hpp"
#include "core/world/density_brick.hpp"
#include "core/world/world_function.hpp"

namespace talus::cli {

/// Columns of a square at even spacing, row by row along z.
struct SurveyGrid {
  glm::dvec2 corner_m{};
  double spacing_m = 1;
  int edge = 0;  ///< columns along each side
  std::vector<float> height_m;
  std::vector<float> ridge;

  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(k) * static_cast<std::size_t>(edge) + static_cast<std::size_t>(i);
  }
  float height(int i, int k) const { return height_m[index(i, k)]; }
  glm::dvec2 place_m(int i, int k) const { return corner_m + glm::dvec2(i, k) * spacing_m; }
};

/// About 1024 columns along each side, on a lattice of the world. Shows progress.
SurveyGrid survey_grid(const WorldFunction& world, const MapArea& area);

inline constexpr int kHypsometricBins = 24;

struct SurveyFigures {
  double land_share = 0;
  std::array<double, 7> height_percentiles_m{};       ///< 1, 5, 25, 50, 75, 95, 99 %
  double bin_low_m = 0, bin_m = 1;                    ///< hypsometric bins: the first one's lower end, and their width
  std::array<double, kHypsometricBins> bin_shares{};  ///< of the whole square
  double sea_mode_m = 0, land_mode_m = 0;             ///< middles of the fullest bins below and above the sea
  std::array<double, 3> slope_percentiles{};          ///< 50, 90, 99 % of land, tangents over two spacings
  double drainage_km_per_km2 = 0;                     ///< length of creases of the ridge map on land
  double coast_km = 0;                                ///< at this spacing
  double coast_dimension = 0;                         ///< by box counting from 1 to 32 spacings
  double overhang_share = 0;                          ///< of land columns: rock above air above rock
  double coast_overhangs_per_km = 0;                  ///< of shore, columns a metre apart that have one
};

/// `probes`: how many columns of land, and of the shore, are looked at for overhangs.
SurveyFigures survey_figures(const WorldFunction& world, const SurveyGrid& grid, int probes = 600);

struct SurveyPlace {
  std::string kind;  ///< peak, canyon, sea cliff, island chain, inland water, trench, rift, overhang, arch
  glm::dvec3 place_m{};
  std::string why;
  double worth = 0;  ///< against others of its kind
};

/// About ten places, the best of each kind, apart from one another. The same for the same grid.
std::vector<SurveyPlace> survey_places(const WorldFunction& world, const SurveyGrid& grid);

/// Whether the column at (x, z) has rock above air above rock between sea floor and summit; with how far the air
/// reaches up from it. Metres; LOD 0.
struct Overhang {
  bool is_there = false;
  double roof_m = 0;  ///< height of the lowest rock above air
  double air_m = 0;   ///< metres of air below it
};
Overhang overhang_at(const WorldFunction& world, glm::dvec2 place_m, DensityBrick& brick);

}  // namespace talus::cli
