#include "core/plates/plate_memo.hpp"

namespace talus {

const Plate& PlateMemo::load(const PlateBuilder& builder, const SiteKey& key) {
  if (slots_.empty()) slots_.resize(kEdge * kEdge);
  const std::size_t x = static_cast<std::uint64_t>(key.x) % kEdge;
  const std::size_t z = static_cast<std::uint64_t>(key.z) % kEdge;
  Slot& slot = slots_[z * kEdge + x];
  if (!slot.known || slot.builder != builder.fingerprint() || slot.plate.seat.site.key != key) {
    builder.build(key, slot.plate);
    slot.known = true;
    slot.builder = builder.fingerprint();
  }
  return slot.plate;
}

}  // namespace talus
