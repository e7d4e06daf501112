#include "server/world/footprint_memo.hpp"

#include "core/grid/chunk_key.hpp"

namespace talus::server {

FootprintMemo::FootprintMemo() : slots_(kSlots) {}

std::size_t FootprintMemo::slot_of(const Footprint& footprint) {
  const ChunkKey key{footprint.lod, footprint.x, static_cast<std::int32_t>(footprint.world), footprint.z};
  return ChunkKeyHash()(key) % kSlots;
}

std::optional<HeightInterval> FootprintMemo::load(const Footprint& footprint) const {
  const std::size_t at = slot_of(footprint);
  const std::lock_guard lock(locks_[at % kLocks]);
  const Slot& slot = slots_[at];
  if (slot.footprint != footprint) return std::nullopt;
  return slot.heights;
}

void FootprintMemo::store(const Footprint& footprint, const HeightInterval& heights) {
  const std::size_t at = slot_of(footprint);
  const std::lock_guard lock(locks_[at % kLocks]);
  slots_[at] = {footprint, heights};
}

}  // namespace talus::server
