// How far each layer stands proud of a wall: 0 for soft beds, 1 for hard ones, softened over three quarters of a metre.
// Pure; made once per world, then only read.
//
// The averages that scale erosion reach over 45 m; a wall shows single beds. So this is a table of its own, in the same
// half-metre slices, blended between the two layer sets that meet at a column as those are.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/strata/strata.hpp"

namespace talus {

class HardnessProfile {
 public:
  explicit HardnessProfile(const Strata& strata);

  /// For `width` columns (rounded up to whole vectors) at one height: out = 0..1.
  void row(const float* stack_m, const float* choice, float height_m, std::size_t width, float* out) const;

  /// Height of the base of a hard bed over a soft one in a column: where the rock of 3 m above stands proud the most
  /// against that of 2.5 m below, within 16 m of `height_m`. Nothing where no beds there differ by a third.
  std::optional<float> ceiling_near(float stack_m, float choice, float height_m) const;

 private:
  void tabulate(const LayerSet& set);

  std::vector<float> proud_;  ///< one table per set, and one more that the last set's neighbour reads with weight 0
};

}  // namespace talus
