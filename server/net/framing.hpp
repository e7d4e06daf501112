// Where messages begin and end on a byte stream. WebSocket and plain TCP differ in nothing else.
//
// Owner: one session. No socket here: bytes are fed in, events come out, heads of frames are written into memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace talus::server {

/// What goes before a message; at most 10 bytes for WebSocket, 4 for TCP.
struct FrameHead {
  std::array<std::byte, 10> bytes{};
  std::size_t size = 0;
};

enum class CloseCode : std::uint16_t {
  kNormal = 1000,
  kGoingAway = 1001,
  kProtocol = 1002,
  kUnsupported = 1003,
  kPolicy = 1008,
  kTooBig = 1009,
  kInternal = 1011
};

struct Inbound {
  enum class Kind : std::uint8_t {
    kMessage,  ///< bytes: one whole message
    kPing,     ///< bytes: to be echoed by `pong`
    kPong,
    kClose,  ///< the peer says goodbye
    kFault   ///< the peer broke the framing; nothing can be read any more
  };
  Kind kind = Kind::kMessage;
  std::span<const std::byte> bytes;  ///< valid until the next call
  CloseCode code = CloseCode::kNormal;
  std::string_view reason;  ///< of a fault, a literal
};

class Framing {
 public:
  Framing() = default;
  virtual ~Framing() = default;
  Framing(const Framing&) = delete;
  Framing& operator=(const Framing&) = delete;

  /// Bytes as they came; they must stay until `next` has returned nothing.
  virtual void feed(std::span<const std::byte> bytes) = 0;
  /// The next event, or nothing when more bytes are needed.
  virtual std::optional<Inbound> next() = 0;
  /// Whether nothing of a message, or of a frame, is held that has not ended.
  virtual bool is_between_messages() const = 0;

  virtual FrameHead message_head(std::size_t message_bytes) const = 0;
  /// Frames of their own; empty where the framing has none.
  virtual std::vector<std::byte> ping() const = 0;
  virtual std::vector<std::byte> pong(std::span<const std::byte> payload) const = 0;
  virtual std::vector<std::byte> close(CloseCode code, std::string_view reason) const = 0;
};

/// Makes room for the next message. The room of a rare long one is given back: most sessions are quiet most of the
/// time, and what each keeps, thousands keep.
inline void empty_message(std::vector<std::byte>& message) {
  constexpr std::size_t kKeptBytes = 1024;
  if (message.capacity() > kKeptBytes) {
    message = std::vector<std::byte>();  // `= {}` would keep the room
  } else {
    message.clear();
  }
}

/// RFC 6455, server side: masked frames required, binary messages only, of at most `message_bytes_max`.
std::unique_ptr<Framing> make_websocket_framing(std::size_t message_bytes_max);
/// `u32 message_bytes`, little-endian, before each message.
std::unique_ptr<Framing> make_tcp_framing(std::size_t message_bytes_max);

}  // namespace talus::server
