// Where tiles of the surface may be had that somebody else evaluated: an owner of threads can let them share.
#pragma once

#include "core/volume/relief_tile.hpp"

namespace talus {

/// Tiles are functions of their name: whoever evaluates one, it has the same bits. Implementations say which threads
/// may call them.
class TileSource {
 public:
  virtual ~TileSource() = default;
  /// Fills `tile` if one of its name and `node_m` is there; else leaves all but its name to anybody's guess.
  virtual bool load(double node_m, ReliefTile& tile) = 0;
  virtual void store(double node_m, const ReliefTile& tile) = 0;
};

}  // namespace talus
