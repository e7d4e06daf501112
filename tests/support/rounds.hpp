// How often a test repeats itself.
#pragma once

#include <algorithm>

namespace talus::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

/// `times`; under a sanitizer, which is ten to twenty times as slow, an eighth. For rounds that differ in numbers
/// alone: which memory a path touches the first of them show, and a release proves them all.
constexpr int rounds(int times) {
  return kIsSanitized ? std::max(1, times / 8) : times;
}

}  // namespace talus::test
