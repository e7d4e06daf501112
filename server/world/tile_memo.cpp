#include "server/world/tile_memo.hpp"

#include <cstdint>

#include "core/base/hash.hpp"

namespace talus::server {

TileMemo::TileMemo(Metrics& metrics) : metrics_(metrics), slots_(kSlots) {}

std::size_t TileMemo::slot_of(double node_m, const TileName& name) {
  const std::uint64_t place = mix64(static_cast<std::uint64_t>(name.x), static_cast<std::uint64_t>(name.z));
  return static_cast<std::size_t>(mix64(mix64(place, name.source), static_cast<std::uint64_t>(node_m)) % kSlots);
}

bool TileMemo::load(double node_m, ReliefTile& tile) {
  const std::size_t at = slot_of(node_m, tile.name);
  bool is_there = false;
  {
    const std::lock_guard lock(locks_[at % kLocks]);
    const Slot& slot = slots_[at];
    is_there = slot.node_m == node_m && slot.tile.name == tile.name;
    if (is_there) tile = slot.tile;
  }
  metrics_.add(is_there ? Count::kTilesRemembered : Count::kTilesEvaluated);
  return is_there;
}

void TileMemo::store(double node_m, const ReliefTile& tile) {
  const std::size_t at = slot_of(node_m, tile.name);
  const std::lock_guard lock(locks_[at % kLocks]);
  slots_[at].node_m = node_m;
  slots_[at].tile = tile;
}

}  // namespace talus::server
