// Messages on plain TCP: each behind its length as four bytes, little-endian (SPEC.md section 2). Bytes only, no
// socket.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "client_sample/library/websocket_frames.hpp"

namespace talus::client {

std::vector<std::byte> length_frame(std::span<const std::byte> message);

/// The counterpart of FrameReader: its events are messages and, at most once, a fault.
class LengthReader {
 public:
  using Event = FrameReader::Event;

  /// Messages longer than `message_bytes_max` are a fault before they are allocated.
  explicit LengthReader(std::size_t message_bytes_max) : message_bytes_max_(message_bytes_max) {}

  /// Bytes as they came; they must stay until next() has returned nothing.
  void feed(std::span<const std::byte> bytes) { input_ = bytes; }
  std::optional<Event> next();

 private:
  std::size_t message_bytes_max_;
  std::span<const std::byte> input_;
  std::array<std::byte, 4> head_{};
  std::size_t head_size_ = 0;
  std::size_t message_bytes_ = 0;
  std::vector<std::byte> message_;
  bool is_message_done_ = false;  ///< message_ was given out and is to be cleared
  bool is_broken_ = false;
};

}  // namespace talus::client
