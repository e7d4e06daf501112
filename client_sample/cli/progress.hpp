// A bar on standard error that fills while work is done; silent where nobody watches. Any thread may step it.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace talus::cli {

class Progress {
 public:
  /// `total` steps are to come. Draws only when standard error is a terminal.
  Progress(std::string label, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step();

 private:
  using Clock = std::chrono::steady_clock;
  void draw();

  std::mutex mutex_;  ///< guards all below
  const std::string label_;
  const std::size_t total_;
  const bool is_shown_;
  const Clock::time_point began_ = Clock::now();
  std::size_t done_ = 0;
};

}  // namespace talus::cli
