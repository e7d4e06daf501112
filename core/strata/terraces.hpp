// Terraces of table land: heights remapped so that hard formations are walls and soft ones treads. Pure.
//
// Problem: ledges of single beds do not make mesas; terraces at even heights look made. Answer: per layer set a
// monotone table from depth to depth whose steepness follows the mean hardness of the rock around, as steep at each
// depth over the mean of its surroundings, so that it stays near the identity. Walls then stand where hard formations
// crop out, at the same layers on every mesa of a district.
#pragma once

#include <span>
#include <vector>

#include "core/strata/layer_set.hpp"

namespace talus {

/// One row of columns. Lanes of weight 0 keep their bits.
struct TerraceRow {
  const float* stack_m;
  const float* choice;
  const float *weight, *weight_x, *weight_z;  ///< of the district, and its slopes per metre
  float *height_m, *slope_x, *slope_z;        ///< changed in place
  std::size_t width;
};

class Terraces {
 public:
  explicit Terraces(std::span<const LayerSet> sets);

  /// Heights of one column keep their order. Slopes leave out those of the stack, which lies flat in table land.
  void row(const TerraceRow& row) const;

  /// No height moves further, in metres.
  float reach_m() const { return reach_m_; }

 private:
  void tabulate(const LayerSet& set);

  std::vector<float> depth_m_;    ///< per set and slice: depth after the remap
  std::vector<float> steepness_;  ///< its slope there
  float reach_m_ = 0;
};

}  // namespace talus
