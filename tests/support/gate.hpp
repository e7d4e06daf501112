// What a test holds threads back with.
#pragma once

#include <condition_variable>
#include <mutex>

namespace talus::test {

/// Closed until it is opened, for good. Any thread.
class Gate {
 public:
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_open_; });
  }
  void open() {
    const std::lock_guard lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = false;
};

}  // namespace talus::test
