// The surface on two lattices of the world, in tiles that are remembered: what warp and carving look around with.
//
// Problem: a fan of columns, a cave's roof and an arch's far side ask for heights at loose points, and the world
// function fills grids. Answer: heights live on the nodes of a lattice of 4 m (fine) and of one of 16 m (wide), in
// tiles of 16 x 16 cells, and everything reads between nodes bilinearly: no overshoot at a rim, so that no value leaves
// the interval of its four nodes. The wide lattice is looked at first: where its nodes hardly rise, the fine one is not
// asked for.
//
// What is read never depends on what is remembered. Memory is the caller's: one per thread, no lock; what threads share
// is behind `TileSource`.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/volume/height_source.hpp"
#include "core/volume/relief_tile.hpp"
#include "core/volume/tile_source.hpp"

namespace talus {

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
  TileSource* others = nullptr;  ///< asked for tiles that are not in the tables, and told of new ones; may be null
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

  /// Base of a hard bed over a soft one near that height, if there is one.
  std::optional<float> ceiling_near(double x_m, double z_m, float height_m) {
    return source_.ceiling_near(x_m, z_m, height_m);
  }

  /// Of fine tile (x, z), without evaluating it.
  TileOutlook outlook(std::int64_t x, std::int64_t z);
  const ReliefTile& fine_tile(std::int64_t x, std::int64_t z);
  std::uint64_t identity() const { return identity_; }

 private:
  const ReliefTile& tile(std::vector<ReliefTile>& slots, std::int64_t window, double node_m, std::int64_t x,
                         std::int64_t z);
  const ReliefTile& wide_tile(std::int64_t x, std::int64_t z);
  const ReliefTile& fine_tile_at(double x_m, double z_m);
  void fill(ReliefTile& tile, double node_m);

  HeightSource& source_;
  ReliefMemory& memory_;
  std::uint64_t identity_;
  /// The fine tile that was read last, and its corner: most points lie where the one before did.
  const ReliefTile* last_ = nullptr;
  double last_x_m_ = 0, last_z_m_ = 0;
};

}  // namespace talus
