// Counts what operator new is asked for in this process.
#pragma once

#include <cstdint>

namespace talus::bench {

/// Allocations since the process started, on all threads.
std::uint64_t allocations();

}  // namespace talus::bench
