// Whether a peer takes what it is sent: not at all for write_stall_s, or slower than read_rate_min over the last
// write_stall_s, is too slow. Judged only while the kernel takes nothing more, so whoever has little to take is not
// hurried. Pure: time is given to it. Owner: one connection.
//
// The time looked back on moves along: bytes that the kernel took at first, or that trickle into it when it probes a
// peer that has stopped reading, must not buy another write_stall_s.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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
    progress_ = now;
    taken_ = 0;
    looks_ = 0;
    look(now);
  }
  void took(std::size_t bytes, Instant now) {
    if (bytes != 0) progress_ = now;
    taken_ += bytes;
  }
  bool is_waiting() const { return is_waiting_; }
  /// Everything was taken.
  void end_wait() { is_waiting_ = false; }

  /// To be asked often; a verdict is late by an eighth of write_stall_s at most.
  Verdict judge(Instant now, const NetLimits& limits) {
    if (!is_waiting_) return Verdict::kFine;
    const std::chrono::duration<double> stall(limits.write_stall_s);
    if (now - progress_ >= stall) return Verdict::kStalled;
    const Look* before = latest_before(now - std::chrono::duration_cast<Duration>(stall));
    const double least = limits.read_rate_min * limits.write_stall_s;
    if (before != nullptr && static_cast<double>(taken_ - before->taken) < least) return Verdict::kTooSlow;
    if (now - last().at >= stall / kLooksPerStall) look(now);
    return Verdict::kFine;
  }

 private:
  /// How much had been taken at one time.
  struct Look {
    Instant at{};
    std::size_t taken = 0;
  };
  static constexpr std::size_t kLooksPerStall = 8;
  /// Those of the last write_stall_s, and one that is older.
  static constexpr std::size_t kLooksKept = kLooksPerStall + 2;

  void look(Instant now) { kept_[looks_++ % kLooksKept] = {now, taken_}; }
  const Look& last() const { return kept_[(looks_ - 1) % kLooksKept]; }
  const Look* latest_before(Instant then) const {
    for (std::size_t i = 1; i <= kLooksKept && i <= looks_; ++i) {
      const Look& one = kept_[(looks_ - i) % kLooksKept];
      if (one.at <= then) return &one;
    }
    return nullptr;
  }

  bool is_waiting_ = false;
  Instant progress_{};
  std::size_t taken_ = 0;  ///< since the wait began
  std::size_t looks_ = 0;
  std::array<Look, kLooksKept> kept_{};
};

inline Count count_of(ReadPace::Verdict verdict) {
  return verdict == ReadPace::Verdict::kStalled ? Count::kWriteStalled : Count::kReadTooSlow;
}

}  // namespace talus::server
