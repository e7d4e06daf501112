// Plates that were made lately, in memory of one thread. Pure: what is remembered never changes a value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/plates/plate.hpp"

namespace talus {

/// A table of 32 x 32 plates by the low bits of their cells: plates of one neighbourhood never displace each other (a
/// chunk of the coarsest LOD and what reaches into it is 24 cells wide), and of two far ones the later stays. About 5
/// KB a plate, so 1 MiB for a walk, and 4 MiB once coarse chunks have filled it; plates are made again in place.
class PlateMemo {
 public:
  /// The plate of `key`, made if it is not here. Valid until the next call.
  const Plate& load(const PlateBuilder& builder, const SiteKey& key);

 private:
  static constexpr std::size_t kEdge = 32;
  struct Slot {
    std::uint64_t builder = 0;  ///< fingerprint
    bool known = false;
    Plate plate;
  };
  std::vector<Slot> slots_;
};

}  // namespace talus
