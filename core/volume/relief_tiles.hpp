// The surface on two lattices of the world, in tiles that are remembered: what warp and carving look around with.
//
// Problem: a fan of columns, a cave's roof and an arch's far side ask for heights at loose points, and the world
// function fills grids. Answer: heights live on the nodes of a lattice of 4 m (fine) and of one of 16 m (wide), in
// tiles of 16 x 16 cells, and everything reads between nodes bilinearly: no overshoot at a rim, so that no value leaves
// the interval of its four nodes. The wide lattice is looked at first: where its nodes hardly rise, the fine one is not
// asked for.
//
// What is read never depends on what is remembered. Memory is the caller's: one per thread, no lock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/volume/height_source.hpp"

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

/// Surface at a point between nodes.
struct ReliefPoint {
  float height_m, slope_x, slope_z;
};

/// Heights of the wide nodes of a fine tile, both ends included, and the steepest edge at any of them.
struct TileOutlook {
  float low_m, high_m, rise;
};

/// Remembered tiles of one thread, in tables of fixed size: 256 fine and 64 wide ones of 4.7 KB, a window of 1 and 2
/// km.
struct ReliefMemory {
  std::vector<ReliefTile> fine, wide;
};

/// Where the wide lattice's edges rise less than `kStillRise`, nothing is warped and nothing carved; from `kOpenRise`
/// on warp is unhindered. In between it opens smoothly, so that a hillside has no edge where warp sets in.
inline constexpr float kStillRise = 0.15f;
inline constexpr float kOpenRise = 0.4f;

class Relief {
 public:
  /// Both must outlive this.
  Relief(HeightSource& source, ReliefMemory& memory);

  /// The surface between fine nodes; positions in metres.
  ReliefPoint at(double x_m, double z_m);
  float height_at(double x_m, double z_m);
  /// The same between wide nodes: the slope of the land at large.
  ReliefPoint wide_at(double x_m, double z_m);
  /// 0 where the land is too gentle for warp, 1 where it is steep, between wide nodes.
  float gate_at(double x_m, double z_m);

  /// Of fine tile (x, z), without evaluating it.
  TileOutlook outlook(std::int64_t x, std::int64_t z);
  const ReliefTile& fine_tile(std::int64_t x, std::int64_t z);
  std::uint64_t identity() const { return identity_; }

 private:
  const ReliefTile& tile(std::vector<ReliefTile>& slots, std::int64_t window, double node_m, std::int64_t x,
                         std::int64_t z);
  const ReliefTile& wide_tile(std::int64_t x, std::int64_t z);
  void fill(ReliefTile& tile, double node_m);

  HeightSource& source_;
  ReliefMemory& memory_;
  std::uint64_t identity_;
};

}  // namespace talus
