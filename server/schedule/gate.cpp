#include "server/schedule/gate.hpp"

#include <utility>

#include "core/base/check.hpp"

namespace talus::server {

Gate::Pass& Gate::Pass::operator=(Pass&& other) noexcept {
  if (this != &other) {
    leave();
    gate_ = std::exchange(other.gate_, nullptr);
  }
  return *this;
}

void Gate::Pass::leave() {
  if (Gate* gate = std::exchange(gate_, nullptr)) gate->leave();
}

Gate::Pass Gate::enter() {
  const std::lock_guard lock(mutex_);
  if (closed_) return Pass{};
  ++inside_;
  return Pass{this};
}

void Gate::close(std::move_only_function<void()> on_empty) {
  {
    const std::lock_guard lock(mutex_);
    TALUS_CHECK(!closed_);
    closed_ = true;
    if (inside_ != 0) {
      on_empty_ = std::move(on_empty);
      return;
    }
  }
  on_empty();
}

void Gate::leave() {
  std::move_only_function<void()> ended;
  {
    const std::lock_guard lock(mutex_);
    --inside_;
    if (closed_ && inside_ == 0) ended = std::exchange(on_empty_, nullptr);
  }
  if (ended) ended();
}

std::size_t Gate::inside() const {
  const std::lock_guard lock(mutex_);
  return inside_;
}

bool Gate::is_closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace talus::server
