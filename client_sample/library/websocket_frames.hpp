// RFC 6455 as a client sees it: server frames in, masked frames out. Bytes only, no socket.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace talus::client {

enum class Opcode : std::uint8_t { kContinuation = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };

/// One final frame, masked with `mask` as RFC 6455 demands of clients.
std::vector<std::byte> masked_frame(Opcode opcode, std::span<const std::byte> payload, std::uint32_t mask);

class FrameReader {
 public:
  struct Event {
    enum class Kind { kMessage, kPing, kPong, kClose, kFault };
    Kind kind = Kind::kMessage;
    std::span<const std::byte> bytes;  ///< valid until the next call of next()
    std::uint16_t close_code = 1005;   ///< of kClose; 1005: none was given
    std::string_view fault;            ///< of kFault: what the server broke; nothing can be read after it
  };

  /// Messages longer than `message_bytes_max` are a fault before they are allocated.
  explicit FrameReader(std::size_t message_bytes_max) : message_bytes_max_(message_bytes_max) {}

  /// Bytes as they came; they must stay until next() has returned nothing.
  void feed(std::span<const std::byte> bytes) { input_ = bytes; }
  std::optional<Event> next();

 private:
  bool read_head();
  std::optional<std::string_view> head_fault() const;
  void begin_payload();
  std::optional<Event> end_frame();
  Event fault(std::string_view what);

  std::size_t message_bytes_max_;
  std::span<const std::byte> input_;
  std::array<std::byte, 10> head_{};
  std::size_t head_size_ = 0;
  bool in_payload_ = false;
  bool is_final_ = false;
  Opcode opcode_{};
  std::uint64_t remaining_ = 0;   ///< payload bytes of this frame still to come
  bool in_message_ = false;       ///< a fragmented message is under way
  bool is_message_done_ = false;  ///< message_ was given out and is to be cleared
  std::vector<std::byte> message_;
  std::vector<std::byte> control_;
  std::string_view fault_;
};

}  // namespace talus::client
