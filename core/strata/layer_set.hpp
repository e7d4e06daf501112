// A stack of rock layers: what lies how deep. Pure; made once per world, then only read.
//
// Problem: thousands of layers, each with its own thickness and rocks, cannot be stored in space. Answer: only their
// thicknesses are, once; the depth of a point below the stack's top, bent by deformation, finds its layer. Based on: a
// description of virtual rock layers in a planet's erosion (layer sets, prefix sums, material distributions). What
// differs: layers come in formations of one character, so that cliffs show bands and not the stripes of a jumper, and
// every set prefers some formations: a country of limestone, one of lava.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/strata/formation.hpp"

namespace talus {

inline constexpr int kLayers = 2048;
/// Every stack is this deep, in metres: from above the highest summit to below the deepest sea floor.
inline constexpr float kStackDepth = 5120.0f;

struct Layer {
  float hardness = 0;  ///< 0 (washed away) .. 1 (stands proud), mean over its rocks
  std::array<Material, kRocksPerLayer> rocks{};
  std::array<float, kRocksPerLayer> cumulative{};  ///< probabilities summed up; the last is 1
};

class LayerSet {
 public:
  explicit LayerSet(std::uint64_t seed);

  const Layer& layer(int index) const { return layers_[static_cast<std::size_t>(index)]; }
  /// Depth of the top of layer `index`, 0..kLayers; tops rise strictly from 0 to kStackDepth.
  float top_m(int index) const { return tops_[static_cast<std::size_t>(index)]; }

  /// The layer whose interval [top, next top) holds `depth_m`; the first above the stack, the last below it.
  int index_at(float depth_m) const;

  /// The rock of a layer where its noise has the quantile `share`, 0 <= share < 1: where `share` is uniform over an
  /// area each rock takes its probability.
  Material rock_at(int index, float share) const;

 private:
  std::vector<Layer> layers_;
  std::vector<float> tops_;           ///< kLayers + 1 prefix sums of thickness
  std::vector<std::uint16_t> start_;  ///< for each slice of kStackDepth the layer at its top: where a search begins
};

}  // namespace talus
