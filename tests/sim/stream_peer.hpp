// A raw streaming client: a socket that speaks WebSocket or plain TCP, and messages.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/message.hpp"
#include "tests/sim/peer.hpp"

namespace talus::server {

struct Arrived {
  int opcode = 2;     ///< of WebSocket; 2 is a message
  std::string bytes;  ///< the frame's payload
};

/// Credit that never runs out.
inline constexpr std::uint64_t kPlenty = std::uint64_t{1} << 40;

class StreamPeer {
 public:
  enum class Carrier { kWebSocket, kTcp };

  StreamPeer(std::string_view address, Carrier carrier = Carrier::kWebSocket, int receive_bytes = 0,
             std::uint32_t host = 0)
      : peer(address, receive_bytes, host), carrier_(carrier) {
    if (carrier == Carrier::kTcp) return;
    peer.send(get_request("/v1/worlds/default/stream",
                          "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                          "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"));
    handshake = peer.take_until("\r\n\r\n");
  }

  void send_bytes(std::string_view bytes, int opcode = 2) {
    std::string frame;
    const auto push = [&](std::size_t value) { frame += static_cast<char>(value); };
    if (carrier_ == Carrier::kTcp) {
      for (int i = 0; i < 4; ++i) push(bytes.size() >> (8 * i));
    } else {
      push(0x80U | static_cast<unsigned>(opcode));
      if (bytes.size() < 126) {
        push(0x80U | bytes.size());
      } else {
        push(0x80U | 126U);
        push(bytes.size() >> 8);
        push(bytes.size());
      }
      frame.append(4, '\0');  // a mask of zeros: the bytes as they are
    }
    frame += bytes;
    peer.send(frame);
  }
  void send(const protocol::Message& message) {
    const auto bytes = protocol::encode(message);
    send_bytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }

  /// The next frame, or nothing at the end of the connection or of two seconds.
  std::optional<Arrived> next_frame() {
    Arrived out;
    std::size_t size = 0;
    if (carrier_ == Carrier::kTcp) {
      const std::string head = peer.take(4);
      if (head.size() < 4) return std::nullopt;
      for (std::size_t i = 4; i-- > 0;) size = size << 8 | static_cast<unsigned char>(head[i]);
    } else {
      const std::string head = peer.take(2);
      if (head.size() < 2) return std::nullopt;
      out.opcode = head[0] & 15;
      size = static_cast<unsigned char>(head[1]) & 127U;
      const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
      if (more != 0) size = 0;
      for (const char c : peer.take(more)) size = size << 8 | static_cast<unsigned char>(c);
    }
    out.bytes = peer.take(size);
    if (out.bytes.size() < size) return std::nullopt;
    return out;
  }
  /// The next message, answering nothing; other frames are skipped and kept in `last_control`.
  std::optional<protocol::Message> next() {
    while (auto frame = next_frame()) {
      if (frame->opcode != 2) {
        last_control = std::move(*frame);
        continue;
      }
      message_bytes = frame->bytes.size();
      const auto bytes = std::as_bytes(std::span(frame->bytes));
      auto decoded = protocol::decode(bytes);
      if (!decoded) return std::nullopt;
      payload.assign(decoded->payload.begin(), decoded->payload.end());
      return std::move(decoded->message);
    }
    return std::nullopt;
  }
  /// The next message of one kind; those before it are dropped.
  template <typename T>
  std::optional<T> next_of() {
    while (auto message = next()) {
      if (auto* found = std::get_if<T>(&*message)) return std::move(*found);
    }
    return std::nullopt;
  }

  bool open(std::uint64_t credit_bytes, std::uint16_t version = 1) {
    protocol::Hello hello;
    hello.version_low = version;
    hello.version_high = version;
    hello.world = "default";
    hello.formats = {"drc"};
    hello.credit_bytes = credit_bytes;
    hello.client = "sim";
    send(hello);
    return next_of<protocol::Welcome>().has_value();
  }
  void look_from(double x, double far_m, std::uint32_t sequence = 1) {
    protocol::ViewMessage view{sequence, {}};
    view.view.position = {x, 600.0, 0.0};
    view.view.far_m = far_m;
    send(view);
  }

  Peer peer;
  std::string handshake;
  std::optional<Arrived> last_control;
  std::size_t message_bytes = 0;   ///< of the last message
  std::vector<std::byte> payload;  ///< behind the last message's head

 private:
  Carrier carrier_;
};

}  // namespace talus::server
