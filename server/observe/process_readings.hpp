// What the process takes of the machine, under the names every Prometheus client library gives them.
#pragma once

#include <cstdint>

#include "server/observe/metrics.hpp"

namespace talus::server {

/// Adds the readings; `started_unix_s` is now, as the caller's clock says it.
void watch_process(Metrics& metrics, std::int64_t started_unix_s);

}  // namespace talus::server
