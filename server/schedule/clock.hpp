// The only place that reads a clock. Everything that waits, ages or measures takes a Clock, so tests move time by hand.
#pragma once

#include <chrono>
#include <cstdint>

namespace talus::server {

using Duration = std::chrono::nanoseconds;
using Instant = std::chrono::time_point<std::chrono::steady_clock, Duration>;

class Clock {
 public:
  Clock() = default;
  virtual ~Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

  /// Monotonic; never earlier than an answer given before on the same thread.
  virtual Instant now() const = 0;
  /// Seconds since 1970, for headers and logs only: it may jump.
  virtual std::int64_t unix_seconds() const = 0;
};

class SystemClock final : public Clock {
 public:
  Instant now() const override;
  std::int64_t unix_seconds() const override;
};

}  // namespace talus::server
