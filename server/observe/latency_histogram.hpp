// How long something takes, counted by many threads at once and read while they go on. Any thread; relaxed atomics.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace talus::server {

/// Buckets are powers of two of 1 us: bucket i counts what took at most 2^i us, the last everything longer.
inline constexpr std::size_t kLatencyBuckets = 25;  // 2^23 us = 8.4 s, and longer

class LatencyHistogram {
 public:
  void record(std::chrono::nanoseconds took) {
    const auto ns = static_cast<std::uint64_t>(took.count() < 0 ? 0 : took.count());
    const std::uint64_t us = (ns + 999) / 1000;
    const std::size_t bucket = us <= 1 ? 0 : static_cast<std::size_t>(std::bit_width(us - 1));
    counts_[bucket < kLatencyBuckets ? bucket : kLatencyBuckets - 1].fetch_add(1, std::memory_order_relaxed);
    total_ns_.fetch_add(ns, std::memory_order_relaxed);
  }

  std::uint64_t count(std::size_t bucket) const { return counts_[bucket].load(std::memory_order_relaxed); }
  double total_seconds() const { return static_cast<double>(total_ns_.load(std::memory_order_relaxed)) * 1e-9; }
  /// Upper bound of a bucket but the last, in seconds.
  static constexpr double bound_seconds(std::size_t bucket) {
    return static_cast<double>(std::uint64_t{1} << bucket) * 1e-6;
  }

 private:
  std::array<std::atomic<std::uint64_t>, kLatencyBuckets> counts_{};
  std::atomic<std::uint64_t> total_ns_{0};
};

}  // namespace talus::server
