// What a world's coasts offer: arches, caves, overhangs and loose rock, counted in blocks of a metre's voxels around
// shores that chance picks. Deterministic: the same blocks for the same grid.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "client_sample/cli/survey.hpp"

namespace talus::cli {

struct CoastFigures {
  double shore_km = 0;              ///< length of the shore that was looked at, 2 m above the sea
  double cliff_share = 0;           ///< of it that rises by 10 m within 6 m
  int arches = 0, caves = 0;        ///< as rock_block.hpp defines them
  double overhang_m2_per_m = 0;     ///< ground under 2 m of air and rock above, a metre of shore
  int loose = 0;                    ///< pieces of rock that hang on nothing
  int loose_m3 = 0;                 ///< the largest of them
  std::vector<SurveyPlace> places;  ///< the arches with the most room, best first
};

/// Looks into `blocks` blocks around shore columns of `grid`. Shows progress.
CoastFigures search_coast(const WorldFunction& world, const SurveyGrid& grid, int blocks);

}  // namespace talus::cli
