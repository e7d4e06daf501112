// Rock layers as the world function meets them: how hard the rock is at a depth, and the ledges that hardness leaves.
// Pure.
//
// Everything is a function of a column's `stack` (height of the stack's top there: the deformation), its `choice`
// (which layer set rules, with a fraction over which two sets blend) and a height. Lookups go through tables of even
// slices, so that a vector of points needs gathers and no search; only the visible rock of a vertex searches its layer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/strata/layer_set.hpp"

namespace talus {

struct StrataControls {
  int sets = 12;
  float ledge = 1.6f;         ///< metres of ledge per metre of the tables' ledge; up to 1.8 heights stay in order
  float ledge_slope = 0.25f;  ///< slope of the relief from which ledges show
  std::uint64_t seed = 0;
};

/// Arrays over one row of columns.
struct StrataRow {
  const float* stack_m;   ///< height of the stack's top
  const float* choice;    ///< 0 .. sets - 1, set and fraction
  const float* district;  ///< noise of about -0.6 .. 0.6: where ledges show at all
  std::size_t width;
};

/// One layer of one set.
struct LayerPlace {
  int set = 0;
  int index = 0;
};

class Strata {
 public:
  explicit Strata(const StrataControls& controls);

  int sets() const { return static_cast<int>(sets_.size()); }
  std::span<const LayerSet> all_sets() const { return sets_; }
  const LayerSet& set(int index) const { return sets_[static_cast<std::size_t>(index)]; }

  /// Mean hardness within 45 m above and below each height: continuous and slow, fit to scale erosion.
  void hardness_row(const StrataRow& row, const float* height_m, float* hardness) const;

  /// Moves eroded heights on to ledges: hard beds steeper, soft ones benches. `relief_x`, `relief_z` are slopes before
  /// erosion; `height_m`, `slope_x` and `slope_z` change in place. Heights of one column keep their order.
  void ledge_row(const StrataRow& row, const float* relief_x, const float* relief_z, float* height_m, float* slope_x,
                 float* slope_z) const;

  /// The layer at height `height_m` of a column.
  LayerPlace layer_at(float stack_m, float choice, float height_m, glm::dvec2 place_m) const;
  /// Its rock there.
  Material rock_at(float stack_m, float choice, float height_m, glm::dvec2 place_m) const;

 private:
  std::uint64_t patch_at(float stack_m, glm::dvec2 place_m) const;
  void tabulate(const LayerSet& set);

  StrataControls controls_;
  std::vector<LayerSet> sets_;
  std::vector<float> ledge_;     ///< kSlicesPerSet values per set: leaky integral of hardness over depth
  std::vector<float> hardness_;  ///< the same: mean hardness around a depth
};

}  // namespace talus
