// Plates that were made lately, in memory of one thread. Pure: what is remembered never changes a value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/plates/plate.hpp"

namespace talus {

/// A table of 16 x 16 plates by the low bits of their cells: plates of one neighbourhood never displace each other, and
/// of two far ones the later stays. About 5 KB a plate, 1.3 MiB when full; plates are made again in place, so memory
/// stops growing soon.
class PlateMemo {
 public:
  /// The plate of `key`, made if it is not here. Valid until the next call.
  const Plate& load(const PlateBuilder& builder, const SiteKey& key);

 private:
  static constexpr std::size_t kEdge = 16;
  struct Slot {
    std::uint64_t builder = 0;  ///< fingerprint
    bool known = false;
    Plate plate;
  };
  std::vector<Slot> slots_;
};

}  // namespace talus
