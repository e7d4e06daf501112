// The spheres that carve notches, caves, alcoves and arches, found from seeds in cells of the world. Pure.
//
// Based on: A. Paris et al., "Terrain Amplification with Implicit 3D Features", 2019 (spheres along a path, subtracted
// from a heightfield), and a description of coastal erosion by spheres that grow from seeds on steep shores. What
// differs: seeds are found by hashing cells, so that no region is ever scanned as a whole; candidates are projected on
// to the elevation they need; alcoves lie in soft beds under hard ones; a roof rule keeps thin shells from forming;
// arches look for the far side first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid/column_grid.hpp"
#include "core/volume/controls.hpp"
#include "core/volume/relief_tiles.hpp"

namespace talus {

/// Centres and radii lie on a lattice of 1/64 m: differences to sample positions are exact in floats wherever they are
/// formed, and a sample is beyond a sphere's reach by all sums or by none.
struct CarveSphere {
  double x_m, z_m;
  float y_m;
  float radius_m;
  float inverse_stretch;  ///< horizontal radius over vertical radius
  CarveKind kind;
};

/// Lists of one thread, by fine tile, in a table of fixed size.
struct CarveMemory {
  struct List {
    bool known = false;
    TileName name;
    std::vector<CarveSphere> spheres;
  };
  std::vector<List> lists;
};

/// A tile gives at most this many: the first in its order.
inline constexpr std::size_t kSpheresPerTile = 2048;

/// Appends to `out` the spheres of all seeds in fine tile (x, z): by pass, by cell, by step.
void grow_tile(const CarveControls& controls, Relief& relief, std::int64_t x, std::int64_t z,
               std::vector<CarveSphere>& out);

/// Replaces `out` by the spheres that density samples over `grid`'s columns can feel, in an order that does not depend
/// on the grid: tile by tile, each in grow_tile's order.
void gather_spheres(const CarveControls& controls, Relief& relief, CarveMemory& memory, const ColumnGrid& grid,
                    std::vector<CarveSphere>& out);

/// Whether every column of `grid` lies on the lattice of `lattice_m`.
bool lies_on(const ColumnGrid& grid, double lattice_m);

}  // namespace talus
