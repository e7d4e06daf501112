// Rock layers as the world function meets them: how hard the rock is at a depth, and the ledges that hardness leaves.
// Pure.
//
// Everything is a function of a column's `stack` (height of the stack's top there: the deformation), its `choice`
// (which layer set rules, with a fraction over which two sets blend) and a height. Lookups go through tables of even
// slices, so that a vector of points needs gathers and no search; only the visible rock of a vertex searches its layer,
// and finds the rock that the layer has there by a noise of the layer's own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/strata/dominant_rock.hpp"
#include "core/strata/facies.hpp"
#include "core/strata/layer_set.hpp"

namespace talus {

struct StrataControls {
  int sets = 12;
  float ledge = 1.6f;         ///< metres of ledge per metre of the tables' ledge; up to 1.8 heights stay in order
  float ledge_slope = 0.25f;  ///< slope of the relief from which ledges show
  double facies_m = 600;      ///< wavelength at which a layer's rock changes
  double wrap_m = 0;          ///< east-west period of the world, 0 for none
  std::uint64_t seed = 0;
};

/// Arrays over one row of columns.
struct StrataRow {
  const float* stack_m;   ///< height of the stack's top
  const float* choice;    ///< 0 .. sets - 1, set and fraction
  const float* district;  ///< noise of about -0.6 .. 0.6: where ledges show at all
  const float* fashion;   ///< 0 .. 1: which beds make the bolder ledges here
  std::size_t width;
};

/// One layer of one set.
struct LayerPlace {
  int set = 0;
  int index = 0;
};

/// A point among the layers, and how much of the world around it is to be spoken for.
struct RockPoint {
  float stack_m;  ///< of its column
  float choice;   ///< the same
  float height_m;
  glm::dvec2 place_m;  ///< x and z from the origin; x reduced to one period where the world wraps
  double span_m = 0;   ///< edge of the cell that asks: from DominantRock::kSpanLow_m on what most of it is made of
};

class Strata {
 public:
  explicit Strata(const StrataControls& controls);

  int sets() const { return static_cast<int>(sets_.size()); }
  std::span<const LayerSet> all_sets() const { return sets_; }
  const LayerSet& set(int index) const { return sets_[static_cast<std::size_t>(index)]; }

  /// Mean hardness within 45 m above and below each height: continuous and slow, fit to scale erosion.
  void hardness_row(const StrataRow& row, const float* height_m, float* hardness) const;
  /// The same of single beds: within 16 m.
  void bed_hardness_row(const StrataRow& row, const float* height_m, float* hardness) const;

  /// Moves eroded heights on to ledges: hard beds steeper, soft ones benches. `relief_x`, `relief_z` are slopes before
  /// erosion; `height_m`, `slope_x` and `slope_z` change in place. Heights of one column keep their order.
  void ledge_row(const StrataRow& row, const float* relief_x, const float* relief_z, float* height_m, float* slope_x,
                 float* slope_z) const;

  /// The layer at a point; in the zone where two sets meet one or the other, in patches.
  LayerPlace layer_at(const RockPoint& point) const;
  /// The rock there: where many places share a layer each of its rocks takes its probability of them.
  Material rock_at(const RockPoint& point) const;

 private:
  int set_at(const RockPoint& point) const;
  void tabulate(const LayerSet& set, std::uint64_t seed);

  StrataControls controls_;
  Facies facies_;
  Facies borders_;  ///< of layer sets
  std::vector<LayerSet> sets_;
  /// kSlicesPerSet values per set: leaky integrals of hardness over depth, with each formation's share of either
  /// fashion.
  std::vector<float> ledge_a_, ledge_b_;
  std::vector<float> hardness_;      ///< the same: mean hardness around a depth
  std::vector<float> bed_hardness_;  ///< the same, within a few beds
  DominantRock dominant_;
};

}  // namespace talus
