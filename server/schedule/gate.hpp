// Refuse new work, and know when the old has ended. Any thread.
//
// Based on: seastar::gate; here the end is told by a callback, as owners of a gate have no thread to wait on.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>

namespace talus::server {

class Gate {
 public:
  /// One unit of work inside the gate; leaves when it is destroyed. Must not outlive its gate.
  class Pass {
   public:
    Pass() = default;
    explicit Pass(Gate* gate) : gate_(gate) {}
    Pass(Pass&& other) noexcept : gate_(other.gate_) { other.gate_ = nullptr; }
    Pass& operator=(Pass&& other) noexcept;
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;
    ~Pass() { leave(); }

    /// False when the gate was closed already: the work must not start.
    explicit operator bool() const { return gate_ != nullptr; }

   private:
    void leave();
    Gate* gate_ = nullptr;
  };

  /// An empty pass once the gate is closed.
  Pass enter();
  /// From now on `enter` refuses; `on_empty` runs once, when the last pass has left, on the thread that left (or right
  /// here). Programmer error when called twice.
  void close(std::move_only_function<void()> on_empty);
  std::size_t inside() const;
  bool is_closed() const;

 private:
  void leave();

  mutable std::mutex mutex_;
  std::size_t inside_ = 0;
  bool closed_ = false;
  std::move_only_function<void()> on_empty_;
};

}  // namespace talus::server
