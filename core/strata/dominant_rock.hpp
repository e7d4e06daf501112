// The rock that most of a span of depth is made of: what a wide cell of a coarse lattice shows. Pure; made once per
// world, then only read.
//
// Problem: a vertex every 32 m or more meets single layers of a few metres at random, and a cliff far away looks
// mottled. Answer: per layer set and power of two of metres a table of the rock with the largest part of the stack
// within half that span above and below, each layer counted by its thickness and by how much of the land each of its
// rocks has. What it gives depends on depth and span alone, so equal LODs agree wherever they meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/strata/layer_set.hpp"

namespace talus {

class DominantRock {
 public:
  /// Sets count from 0 in the order in which they are added.
  void add(const LayerSet& set);

  /// From this span on it is the better answer, in metres.
  static constexpr double kSpanLow_m = 16.0;

  /// Rock of set `set` around a depth. `span_m` is rounded down to a power of two and held within 16..512 m.
  Material at(int set, float depth_m, double span_m) const;

 private:
  static constexpr int kSpans = 6;  ///< 16, 32 .. 512 m

  std::vector<Material> rocks_;  ///< by set, span, slice
};

}  // namespace talus
