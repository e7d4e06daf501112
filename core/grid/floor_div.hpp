// Division of lattice coordinates that rounds down on both sides of the origin. Pure.
#pragma once

#include <cstdint>

namespace talus {

/// The largest q with q * divisor <= value. Requires divisor > 0.
constexpr std::int64_t floor_div(std::int64_t value, std::int64_t divisor) {
  const std::int64_t quotient = value / divisor;
  return value % divisor < 0 ? quotient - 1 : quotient;
}

}  // namespace talus
