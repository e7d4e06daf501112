// Integer hashes: the only source of chance in the world. Pure, the same on every machine.
#pragma once

#include <cstdint>

namespace talus {

/// A bijection of 64 bits in which every input bit reaches every output bit.
/// Based on: the finaliser of SplitMix64, S. Vigna's constants after D. Stafford, "Better Bit Mixing", 2011.
constexpr std::uint64_t mix64(std::uint64_t v) {
  v ^= v >> 30;
  v *= 0xBF58476D1CE4E5B9ULL;
  v ^= v >> 27;
  v *= 0x94D049BB133111EBULL;
  v ^= v >> 31;
  return v;
}

/// One value from two; not symmetric.
constexpr std::uint64_t mix64(std::uint64_t a, std::uint64_t b) {
  return mix64(mix64(a + 0x9E3779B97F4A7C15ULL) ^ (b + 0xD1B54A32D192ED03ULL));
}

}  // namespace talus
