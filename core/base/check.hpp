// Programmer errors end the process with a line that says where; they never reach a peer. Pure but for that end.
#pragma once

#include <source_location>

namespace talus {

/// Writes `condition`, file and line to standard error and aborts.
[[noreturn]] void check_failed(const char* condition, std::source_location where);

}  // namespace talus

/// Holds an invariant of our own code. Never used on a value that came from outside: those get a std::expected.
#define TALUS_CHECK(condition)                                            \
  do {                                                                    \
    if (!(condition)) [[unlikely]]                                        \
      ::talus::check_failed(#condition, std::source_location::current()); \
  } while (false)
