// The macro field: what plates make of the ground before hills and erosion. The door of core/plates. Pure.
//
// Problem: continents, ranges and coasts should follow from plates and their faults, yet be a function of a point that
// costs little. Answer: plates are Voronoi polygons of hashed sites, a fault is a noised line between two of them, and
// the ground at a point is a blend of the profiles of the faults around it, evaluated with its gradient at the nodes of
// a lattice and interpolated between them. Based on: a description of plates, faults and coasts on a tile map (floods
// from each plate's centre, lines drawn along faults). What differs: nothing is drawn or flooded; every distance is
// evaluated where it is wanted, so there is no map and no edge.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/column_grid.hpp"
#include "core/plates/plate.hpp"
#include "core/plates/plate_gather.hpp"
#include "core/plates/plate_memo.hpp"

namespace talus {

/// Voxels between nodes of the macro lattice. A grid whose step is a multiple of it evaluates its columns directly.
inline constexpr std::int64_t kMacroNodeVoxels = 32;

/// Working memory of one thread: plates made lately, and arrays. Never part of a value.
struct MacroScratch {
  PlateMemo plates;
  PlateGather gather;
  std::vector<float> arrays;
};

/// What is filled: sample_count(grid) floats each, in metres and metres per metre.
struct MacroArrays {
  float *height, *height_x, *height_z;           ///< the ground, and its slopes
  float *hilliness, *hilliness_x, *hilliness_z;  ///< 0 (plain) .. 1 (range), and its slopes per metre
  float* floor;                                  ///< the ground without what faults raise: where the valleys are
  float* lift;                                   ///< from there to the peaks around
};

class MacroField {
 public:
  MacroField(const PlateControls& plates, const MacroControls& macro);

  const PlateBuilder& plates() const { return plates_; }
  /// Two calls that cover the same column give it the same bits.
  void sample(const ColumnGrid& grid, MacroScratch& scratch, const MacroArrays& out) const;
  /// No height lies outside these, in metres.
  double low_m() const;
  double high_m() const;

 private:
  struct Nodes;
  void fill_nodes(const ColumnGrid& nodes, MacroScratch& scratch, const Nodes& out) const;
  void sum_plates(const ColumnGrid& nodes, MacroScratch& scratch, const Nodes& out) const;
  void sample_apart(const ColumnGrid& grid, MacroScratch& scratch, const MacroArrays& out) const;

  PlateBuilder plates_;
  FractalNoise uplift_, arc_, pass_, swell_, coast_;
};

}  // namespace talus
