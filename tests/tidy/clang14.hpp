// What clang-tidy 14 lacks to read code written for g++ 12 and its library. Included before every source, by clang-tidy
// alone; never compiled.
#pragma once
#pragma clang system_header

// libstdc++ 12 has std::expected only for compilers with all of C++20's concepts; clang 14 reads it well enough.
#undef __cpp_concepts
#define __cpp_concepts 202002L

#include <cstdint>

namespace std {

// libstdc++ 12 makes it of a builtin that came with clang 15.
struct source_location {
  static constexpr source_location current() noexcept { return {}; }
  constexpr const char* file_name() const noexcept { return ""; }
  constexpr const char* function_name() const noexcept { return ""; }
  constexpr std::uint_least32_t line() const noexcept { return 0; }
  constexpr std::uint_least32_t column() const noexcept { return 0; }
};

}  // namespace std
