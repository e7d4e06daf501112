// Whether a peer takes what it is sent: not at all for write_stall_s, or slower than read_rate_min over as long, is too
// slow. Judged only while the kernel takes nothing more, so whoever has little to take is not hurried. Pure: time is
// given to it. Owner: one connection.
#pragma once

#include <cstddef>

#include "server/net/limits.hpp"
#include "server/observe/metrics.hpp"
#include "server/schedule/clock.hpp"

namespace talus::server {

class ReadPace {
 public:
  enum class Verdict : std::uint8_t { kFine, kStalled, kTooSlow };

  /// The kernel is full.
  void begin_wait(Instant now) {
    if (is_waiting_) return;
    is_waiting_ = true;
    progress_ = window_ = now;
    bytes_ = 0;
  }
  void took(std::size_t bytes, Instant now) {
    if (bytes != 0) progress_ = now;
    bytes_ += bytes;
  }
  bool is_waiting() const { return is_waiting_; }
  /// Everything was taken.
  void end_wait() { is_waiting_ = false; }

  Verdict judge(Instant now, const NetLimits& limits) {
    const std::chrono::duration<double> stall(limits.write_stall_s);
    if (!is_waiting_) return Verdict::kFine;
    if (now - progress_ >= stall) return Verdict::kStalled;
    if (now - window_ < stall) return Verdict::kFine;
    const bool is_slow = static_cast<double>(bytes_) < limits.read_rate_min * limits.write_stall_s;
    window_ = now;
    bytes_ = 0;
    return is_slow ? Verdict::kTooSlow : Verdict::kFine;
  }

 private:
  bool is_waiting_ = false;
  Instant progress_{};
  Instant window_{};
  std::size_t bytes_ = 0;
};

inline Count count_of(ReadPace::Verdict verdict) {
  return verdict == ReadPace::Verdict::kStalled ? Count::kWriteStalled : Count::kReadTooSlow;
}

}  // namespace talus::server
