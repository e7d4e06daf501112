// The ground of one column of chunks as a heightfield on its lattice: what an engine with terrain of its own wants.
// Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid/chunk_key.hpp"
#include "core/world/world_function.hpp"

namespace talus {

/// (cells + 1)^2 columns, neighbours sharing a border; column (i, k) is at k * (cells + 1) + i. Arrays have equal
/// length.
struct HeightTile {
  int cells = 0;
  double step_m = 0.0;                ///< of the heights: that of the LOD's mesh lattice, a power of two
  std::vector<std::int32_t> heights;  ///< steps above the sea, rounded
  std::vector<std::uint8_t> ridges;   ///< ridge map, 0 (crease) .. 255 (ridge)
  std::vector<std::uint8_t> materials;
};

/// Quantises `columns`, which must be those of chunk_columns for any chunk of that column. The heights are the ground's
/// before anything hollows it.
void sample_height_tile(const WorldFunction& world, const ColumnBlock& columns, HeightTile& out);

/// Steepness of the ground as the y component of its unit normal, by central differences; (i, k) without the halo.
float ground_up(const ColumnBlock& columns, int i, int k);

/// What one meets at `height_m` of column (i, k), without the halo, where the surface has a unit normal of y `up`.
Material surface_material(const WorldFunction& world, const ColumnBlock& columns, int i, int k, float up,
                          float height_m);

}  // namespace talus
