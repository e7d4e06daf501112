// A square of nodes of the surface: what relief tiles hold. Pure data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace talus {

/// Cells along a tile's edge; its nodes include both ends.
inline constexpr int kTileCells = 16;
inline constexpr int kTileNodes = kTileCells + 1;
/// Spacing of nodes, in metres: a whole number of voxels, as voxels are 0.25 .. 4 m and powers of two.
inline constexpr double kFineNode_m = 4.0;
inline constexpr double kWideNode_m = 16.0;
inline constexpr double kFineTile_m = kFineNode_m * kTileCells;
inline constexpr double kWideTile_m = kWideNode_m * kTileCells;

struct TileName {
  std::uint64_t source = 0;
  std::int64_t x = 0;  ///< in tiles
  std::int64_t z = 0;
  friend bool operator==(const TileName&, const TileName&) = default;
};

/// Node (i, k) is at k * kTileNodes + i.
struct ReliefTile {
  using Nodes = std::array<float, static_cast<std::size_t>(kTileNodes* kTileNodes)>;
  bool known = false;
  TileName name;
  Nodes height_m, slope_x, slope_z;  ///< slopes are central differences over two cells
  Nodes rise;                        ///< steepest of the four edges at a node, as a slope
};

}  // namespace talus
