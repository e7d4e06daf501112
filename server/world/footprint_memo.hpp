// Heights that chunks' columns were seen to have, so that the air and rock above and below a surface cost no
// evaluation.
//
// Problem: of the chunks stacked over one square of ground one or two hold a surface, and each would evaluate the same
// columns to find out. Answer: the lowest and highest surface of a square, once known, rule the others out. A table of
// fixed size in which a new square takes the place of an old one: forgetting costs time, never truth. Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace talus::server {

/// The square of ground under a stack of chunks of one LOD.
struct Footprint {
  std::uint32_t world = 0;
  std::int32_t lod = 0;
  std::int32_t x = 0;
  std::int32_t z = 0;
  friend bool operator==(const Footprint&, const Footprint&) = default;
};

/// Its columns, halo included, are rock below and air from `high_m` on, in metres.
struct HeightInterval {
  float low_m = 0;
  float high_m = 0;
  friend bool operator==(const HeightInterval&, const HeightInterval&) = default;
};

class FootprintMemo {
 public:
  FootprintMemo();

  std::optional<HeightInterval> load(const Footprint& footprint) const;
  void store(const Footprint& footprint, const HeightInterval& heights);

 private:
  /// 16,384 squares of 24 bytes: a 12 km view has about 500.
  static constexpr std::size_t kSlots = 16'384;
  static constexpr std::size_t kLocks = 64;

  struct Slot {
    Footprint footprint{0, -1, 0, 0};  ///< LOD -1: empty
    HeightInterval heights;
  };
  static std::size_t slot_of(const Footprint& footprint);

  std::vector<Slot> slots_;
  mutable std::array<std::mutex, kLocks> locks_;  ///< lock i guards the slots that are i modulo kLocks
};

}  // namespace talus::server
