// So much a second, and a burst. Pure: time is given to it. Owner: one session.
#pragma once

#include <algorithm>

#include "server/schedule/clock.hpp"

namespace talus::server {

class TokenBucket {
 public:
  TokenBucket(double per_second, double burst, Instant now)
      : per_second_(per_second), burst_(burst), tokens_(burst), filled_(now) {}

  /// Takes `cost`, or nothing and says false when there is not enough.
  bool take(double cost, Instant now) {
    const double passed_s = std::chrono::duration<double>(now - filled_).count();
    tokens_ = std::min(burst_, tokens_ + std::max(0.0, passed_s) * per_second_);
    filled_ = now;
    if (cost > tokens_) return false;
    tokens_ -= cost;
    return true;
  }

 private:
  double per_second_;
  double burst_;
  double tokens_;
  Instant filled_;
};

}  // namespace talus::server
