// "Nobody wants this any more", said once by an owner and read now and then by the work. Any thread.
#pragma once

#include <atomic>
#include <memory>

namespace talus::server {

/// Copies share one state. Cancelling is final: work that is wanted again starts again with a token of its own.
class CancelToken {
 public:
  CancelToken() : state_(std::make_shared<std::atomic<bool>>(false)) {}

  void cancel() { state_->store(true, std::memory_order_relaxed); }
  bool is_cancelled() const { return state_->load(std::memory_order_relaxed); }

 private:
  std::shared_ptr<std::atomic<bool>> state_;
};

}  // namespace talus::server
