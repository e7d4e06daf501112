// How long something takes. One thread counts, without a locked instruction; any thread reads while it goes on.
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

/// A number that one thread adds to. Any thread may read it.
class OwnCount {
 public:
  void add(std::uint64_t by) { value_.store(value() + by, std::memory_order_relaxed); }
  std::uint64_t value() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

class LatencyHistogram {
 public:
  void record(std::chrono::nanoseconds took) {
    const auto ns = static_cast<std::uint64_t>(took.count() < 0 ? 0 : took.count());
    const std::uint64_t us = (ns + 999) / 1000;
    const std::size_t bucket = us <= 1 ? 0 : static_cast<std::size_t>(std::bit_width(us - 1));
    counts_[bucket < kLatencyBuckets ? bucket : kLatencyBuckets - 1].add(1);
    total_ns_.add(ns);
  }
  /// What another has counted too.
  void add(const LatencyHistogram& other) {
    for (std::size_t i = 0; i < kLatencyBuckets; ++i) counts_[i].add(other.count(i));
    total_ns_.add(other.total_ns_.value());
  }

  std::uint64_t count(std::size_t bucket) const { return counts_[bucket].value(); }
  double total_seconds() const { return static_cast<double>(total_ns_.value()) * 1e-9; }
  /// Upper bound of a bucket but the last, in seconds.
  static constexpr double bound_seconds(std::size_t bucket) {
    return static_cast<double>(std::uint64_t{1} << bucket) * 1e-6;
  }

 private:
  std::array<OwnCount, kLatencyBuckets> counts_{};
  OwnCount total_ns_;
};

}  // namespace talus::server
