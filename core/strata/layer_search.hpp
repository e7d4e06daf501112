// Layers of many depths at once. Pure.
//
// Problem: a binary search over 2048 layers costs tens of nanoseconds a point. Answer: a table of even slices of depth
// says at which layer a search begins; slices are thinner than most layers, so that a vector of points scans one or
// two. Gives what LayerSet::index_at gives.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/strata/layer_set.hpp"

namespace talus {

class LayerSearch {
 public:
  explicit LayerSearch(const LayerSet& set);

  /// layers[i] = the layer that holds depths_m[i]. Both spans are of one size.
  void find(std::span<const float> depths_m, std::span<std::int32_t> layers) const;

 private:
  std::vector<float> tops_;           ///< of every layer, and what no depth reaches
  std::vector<std::int32_t> begins_;  ///< layer at the top of each slice: 64 KiB
};

}  // namespace talus
