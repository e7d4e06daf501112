// What a session has to send, in two lanes: control messages never wait behind chunks. Bounded by its session, which
// looks at `bytes` before it pushes. Owner: the session's thread.
#pragma once

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "server/cache/payload.hpp"
#include "server/net/framing.hpp"

namespace talus::server {

/// One frame: its head, the message's own bytes, and for a chunk the shared payload, which is never copied.
struct OutFrame {
  FrameHead head;
  std::vector<std::byte> message;
  PayloadRef payload;

  /// What the client's credit is charged: the message without its framing.
  std::size_t message_bytes() const { return message.size() + (payload == nullptr ? 0 : payload->bytes.size()); }
  std::size_t bytes() const { return head.size + message_bytes(); }
};

class SendQueue {
 public:
  void push_control(OutFrame frame) {
    bytes_ += frame.bytes();
    control_.push_back(std::move(frame));
  }
  void push_bulk(OutFrame frame) {
    bytes_ += frame.bytes();
    bulk_.push_back(std::move(frame));
  }
  /// Moves the next frames to `batch`, control first, up to `frames_max` and until `bytes_max` is reached.
  void pop_batch(std::size_t frames_max, std::size_t bytes_max, std::vector<OutFrame>& batch) {
    std::size_t taken = 0;
    while (batch.size() < frames_max && taken < bytes_max && !empty()) {
      std::deque<OutFrame>& lane = control_.empty() ? bulk_ : control_;
      taken += lane.front().bytes();
      batch.push_back(std::move(lane.front()));
      lane.pop_front();
    }
    bytes_ -= taken;
  }
  void drop_bulk() {
    for (const OutFrame& frame : bulk_) bytes_ -= frame.bytes();
    bulk_.clear();
  }

  bool empty() const { return control_.empty() && bulk_.empty(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t control_frames() const { return control_.size(); }

 private:
  std::deque<OutFrame> control_;
  std::deque<OutFrame> bulk_;
  std::size_t bytes_ = 0;
};

}  // namespace talus::server
