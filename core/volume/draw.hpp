// Chance for one cell of one pass: numbers that follow from its seed one after the other. Pure.
#pragma once

#include <cstdint>

#include "core/base/hash.hpp"

namespace talus {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  /// 0 <= v < 1.
  float unit() { return static_cast<float>(mix64(seed_, next_++) >> 40) * 0x1p-24f; }
  float between(float low, float high) { return low + (high - low) * unit(); }
  /// low <= v <= high.
  int whole(int low, int high) {
    return low + static_cast<int>(mix64(seed_, next_++) % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
};

}  // namespace talus
