// Tiles of ground that pool threads evaluated while they looked around for warp and carving, for each other.
//
// Problem: the chunks of a view lie around the same cliffs, and every thread evaluated the ground there for itself: at
// a cliff coast a third of a cold view's CPU with two threads, two fifths with eight. Answer: one table of fixed size
// in which a new tile takes the place of an old one. Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <mutex>
#include <vector>

#include "core/volume/tile_source.hpp"
#include "server/observe/metrics.hpp"

namespace talus::server {

class TileMemo final : public TileSource {
 public:
  explicit TileMemo(Metrics& metrics);
  bool load(double node_m, ReliefTile& tile) override;
  void store(double node_m, const ReliefTile& tile) override;

 private:
  /// 2048 tiles of 4.7 KB, 10 MB: the fine ones of a square of 3 km.
  static constexpr std::size_t kSlots = 2048;
  static constexpr std::size_t kLocks = 64;
  struct Slot {
    double node_m = 0;  ///< 0: empty
    ReliefTile tile;
  };
  static std::size_t slot_of(double node_m, const TileName& name);

  Metrics& metrics_;
  std::vector<Slot> slots_;
  std::array<std::mutex, kLocks> locks_;  ///< lock i guards the slots that are i modulo kLocks
};

}  // namespace talus::server
