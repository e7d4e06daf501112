#include "client_sample/load/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace talus::load {

/// Values below 2 * kSteps have a bucket each; beyond, one of kSteps to each power of two.
std::size_t Histogram::bucket_of(std::uint64_t us) {
  if (us < 2 * kSteps) return static_cast<std::size_t>(us);
  const auto shift = static_cast<std::size_t>(std::bit_width(us)) - kStepsLog2 - 1;
  return std::min(shift * kSteps + static_cast<std::size_t>(us >> shift), kSteps * (kPowers + 1) - 1);
}

double Histogram::middle_us(std::size_t bucket) {
  if (bucket < 2 * kSteps) return static_cast<double>(bucket);
  const std::size_t shift = bucket / kSteps - 1;
  const std::size_t step = bucket - shift * kSteps;
  return std::ldexp(static_cast<double>(step) + 0.5, static_cast<int>(shift));
}

void Histogram::record(std::chrono::nanoseconds took) {
  const auto us = static_cast<std::uint64_t>(std::max<std::chrono::nanoseconds::rep>(took.count(), 0) / 1000);
  ++counts_[bucket_of(us)];
  ++count_;
  sum_us_ += us;
  max_us_ = std::max(max_us_, us);
}

void Histogram::add(const Histogram& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
  sum_us_ += other.sum_us_;
  max_us_ = std::max(max_us_, other.max_us_);
}

double Histogram::quantile_s(double q) const {
  if (count_ == 0) return 0.0;
  const auto rank = static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    below += counts_[i];
    if (below >= std::max<std::uint64_t>(rank, 1)) return std::min(middle_us(i) * 1e-6, max_s());
  }
  return max_s();
}

double Histogram::mean_s() const {
  return count_ == 0 ? 0.0 : static_cast<double>(sum_us_) * 1e-6 / static_cast<double>(count_);
}

}  // namespace talus::load
