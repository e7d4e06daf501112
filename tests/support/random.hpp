// Chance for property tests: seeded, printed on failure, the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/hash.hpp"

namespace talus::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() { return mix64(state_++, 0x7E57); }
  /// 0 <= v < 1.
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double real(double low, double high) { return low + (high - low) * unit(); }
  /// low <= v <= high.
  std::int64_t whole(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::uint64_t state_;
};

/// Bytes without a pattern, the same for the same size.
inline std::vector<std::byte> noise(std::size_t size) {
  Random random(size);
  std::vector<std::byte> out(size);
  for (std::byte& b : out) b = static_cast<std::byte>(random.bits() & 0xFF);
  return out;
}

}  // namespace talus::test
