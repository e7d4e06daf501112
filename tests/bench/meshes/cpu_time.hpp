// CPU time of this thread between start and stop, summed: other work on the machine does not count.
#pragma once

#include <ctime>

namespace talus::bench {

class CpuTime {
 public:
  void start() { began_s_ = now_s(); }
  void stop() { sum_s_ += now_s() - began_s_; }
  double seconds() const { return sum_s_; }

 private:
  static double now_s() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }
  double began_s_ = 0.0;
  double sum_s_ = 0.0;
};

}  // namespace talus::bench
