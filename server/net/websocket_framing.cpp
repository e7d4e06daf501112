#include <wslay/wslay.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "server/net/framing.hpp"

namespace talus::server {

namespace {

constexpr std::size_t kControlBytesMax = 125;  // RFC 6455, 5.5

/// Of a client's frame: two bytes, the length if it is longer than seven bits (in its shortest form, or wslay refuses),
/// and the mask.
std::uint64_t head_bytes(std::uint64_t payload_bytes) {
  return 2U + (payload_bytes < 126 ? 0U : payload_bytes <= 0xFFFF ? 2U : 8U) + 4U;
}

std::vector<std::byte> control_frame(std::uint8_t opcode, std::span<const std::byte> payload) {
  const std::size_t size = std::min(payload.size(), kControlBytesMax);
  std::vector<std::byte> out{static_cast<std::byte>(0x80 | opcode), static_cast<std::byte>(size)};
  out.insert(out.end(), payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size));
  return out;
}

/// wslay reads frames; fragments are put together here, so that a limit is tested before a byte is kept.
class WebSocketFraming final : public Framing {
 public:
  explicit WebSocketFraming(std::size_t message_bytes_max) : message_bytes_max_(message_bytes_max) {
    const wslay_frame_callbacks callbacks{nullptr, &WebSocketFraming::receive, nullptr};
    wslay_frame_context_ptr context = nullptr;
    if (wslay_frame_context_init(&context, &callbacks, this) != 0) throw std::bad_alloc();
    context_.reset(context);
  }

  void feed(std::span<const std::byte> bytes) override { input_ = bytes; }

  std::optional<Inbound> next() override {
    if (is_whole_) empty_message(message_);
    is_whole_ = false;
    while (!is_broken_) {
      wslay_frame_iocb part{};
      const ssize_t taken = wslay_frame_recv(context_.get(), &part);
      if (taken == WSLAY_ERR_WANT_READ) return std::nullopt;
      if (taken < 0) return fault(CloseCode::kProtocol, "not a WebSocket frame");
      if (auto event = take(part)) return event;
    }
    return std::nullopt;
  }

  bool is_between_messages() const override { return taken_bytes_ == framed_bytes_ && !is_in_message_; }

  FrameHead message_head(std::size_t message_bytes) const override {
    FrameHead head;
    const auto push = [&](std::size_t value) { head.bytes[head.size++] = static_cast<std::byte>(value); };
    push(0x80 | WSLAY_BINARY_FRAME);
    if (message_bytes < 126) {
      push(message_bytes);
    } else {
      const bool is_long = message_bytes > 0xFFFF;
      push(is_long ? 127 : 126);
      for (std::size_t i = is_long ? 8 : 2; i-- > 0;) push(message_bytes >> (8 * i));
    }
    return head;
  }

  std::vector<std::byte> ping() const override { return control_frame(WSLAY_PING, {}); }
  std::vector<std::byte> pong(std::span<const std::byte> payload) const override {
    return control_frame(WSLAY_PONG, payload);
  }
  std::vector<std::byte> close(CloseCode code, std::string_view reason) const override {
    const auto value = static_cast<std::uint16_t>(code);
    std::vector<std::byte> payload{static_cast<std::byte>(value >> 8), static_cast<std::byte>(value & 0xFF)};
    const auto text = std::as_bytes(std::span(reason.substr(0, kControlBytesMax - 2)));
    payload.insert(payload.end(), text.begin(), text.end());
    return control_frame(WSLAY_CONNECTION_CLOSE, payload);
  }

 private:
  struct Free {
    void operator()(wslay_frame_context* context) const { wslay_frame_context_free(context); }
  };

  static ssize_t receive(std::uint8_t* buffer, std::size_t length, int /*flags*/, void* user) {
    auto& framing = *static_cast<WebSocketFraming*>(user);
    auto& input = framing.input_;
    if (input.empty()) return -1;
    const std::size_t taken = std::min(length, input.size());
    std::memcpy(buffer, input.data(), taken);
    input = input.subspan(taken);
    framing.taken_bytes_ += taken;
    return static_cast<ssize_t>(taken);
  }

  Inbound fault(CloseCode code, std::string_view reason) {
    is_broken_ = true;
    return {Inbound::Kind::kFault, {}, code, reason};
  }

  /// The first part of a frame decides whether the frame may be; every part adds its bytes; the last ends the frame.
  std::optional<Inbound> take(const wslay_frame_iocb& part) {
    const bool is_control = wslay_is_ctrl_frame(part.opcode) != 0;
    if (!is_in_frame_) {
      frame_taken_ = 0;
      if (auto refused = open_frame(part, is_control)) return refused;
      is_in_frame_ = true;
    }
    std::vector<std::byte>& into = is_control ? control_ : message_;
    const auto bytes = std::as_bytes(std::span(part.data, part.data_length));
    into.insert(into.end(), bytes.begin(), bytes.end());
    frame_taken_ += part.data_length;
    if (frame_taken_ < part.payload_length) return std::nullopt;
    is_in_frame_ = false;
    framed_bytes_ += head_bytes(part.payload_length) + part.payload_length;
    return is_control ? end_control(part.opcode) : end_data(part.fin != 0);
  }

  std::optional<Inbound> open_frame(const wslay_frame_iocb& part, bool is_control) {
    if (part.mask == 0) return fault(CloseCode::kProtocol, "a client's frame must be masked");
    if (part.rsv != 0) return fault(CloseCode::kProtocol, "reserved bits are set");
    if (is_control) {
      const bool is_known =
          part.opcode == WSLAY_CONNECTION_CLOSE || part.opcode == WSLAY_PING || part.opcode == WSLAY_PONG;
      if (!is_known) return fault(CloseCode::kProtocol, "an unknown control frame");
      if (part.fin == 0 || part.payload_length > kControlBytesMax) {
        return fault(CloseCode::kProtocol, "a control frame is fragmented or too large");
      }
      control_.clear();
      return std::nullopt;
    }
    if (part.opcode == WSLAY_TEXT_FRAME) return fault(CloseCode::kUnsupported, "messages are binary");
    const bool continues = part.opcode == WSLAY_CONTINUATION_FRAME;
    if (part.opcode > WSLAY_BINARY_FRAME || continues != is_in_message_) {
      return fault(CloseCode::kProtocol, "a data frame out of order");
    }
    if (part.payload_length > message_bytes_max_ - message_.size()) {
      return fault(CloseCode::kTooBig, "the declared message is too large");
    }
    is_in_message_ = true;
    return std::nullopt;
  }

  std::optional<Inbound> end_control(std::uint8_t opcode) {
    const auto kind = opcode == WSLAY_PING   ? Inbound::Kind::kPing
                      : opcode == WSLAY_PONG ? Inbound::Kind::kPong
                                             : Inbound::Kind::kClose;
    return Inbound{kind, control_, CloseCode::kNormal, {}};
  }

  std::optional<Inbound> end_data(bool is_last) {
    if (!is_last) return std::nullopt;
    is_in_message_ = false;
    is_whole_ = true;
    return Inbound{Inbound::Kind::kMessage, message_, CloseCode::kNormal, {}};
  }

  const std::size_t message_bytes_max_;
  std::unique_ptr<wslay_frame_context, Free> context_;
  std::span<const std::byte> input_;
  std::vector<std::byte> message_;
  std::vector<std::byte> control_;
  std::uint64_t frame_taken_ = 0;
  std::uint64_t taken_bytes_ = 0;   ///< by wslay, which may hold the beginning of the next frame
  std::uint64_t framed_bytes_ = 0;  ///< of frames that have ended
  bool is_in_frame_ = false;
  bool is_in_message_ = false;
  bool is_whole_ = false;
  bool is_broken_ = false;
};

}  // namespace

std::unique_ptr<Framing> make_websocket_framing(std::size_t message_bytes_max) {
  return std::make_unique<WebSocketFraming>(message_bytes_max);
}

}  // namespace talus::server
