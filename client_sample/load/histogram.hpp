// Latencies by count, for any number of them in a fixed 17 KiB. Pure.
//
// Log-linear buckets, after G. Tene's HdrHistogram (2012): 64 to each power of two of microseconds, so a value read
// back is within 1/128 (0.8 %) of what was recorded, from 128 us on; below, it is exact to the microsecond.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace talus::load {

class Histogram {
 public:
  void record(std::chrono::nanoseconds took);
  void add(const Histogram& other);

  std::uint64_t count() const { return count_; }
  /// The value that a share `q` of all is not above; 0 of nothing. Seconds.
  double quantile_s(double q) const;
  double mean_s() const;
  double max_s() const { return static_cast<double>(max_us_) * 1e-6; }

 private:
  static constexpr std::size_t kStepsLog2 = 6;
  static constexpr std::size_t kSteps = std::size_t{1} << kStepsLog2;
  static constexpr std::size_t kPowers = 32;  ///< up to 2^38 us, three days
  static std::size_t bucket_of(std::uint64_t us);
  static double middle_us(std::size_t bucket);

  std::array<std::uint64_t, kSteps*(kPowers + 1)> counts_{};
  std::uint64_t count_ = 0;
  std::uint64_t sum_us_ = 0;
  std::uint64_t max_us_ = 0;
};

}  // namespace talus::load
