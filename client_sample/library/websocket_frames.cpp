#include "client_sample/library/websocket_frames.hpp"

#include <algorithm>
#include <cstring>

namespace talus::client {
namespace {

constexpr std::size_t kControlBytesMax = 125;

bool is_control(Opcode opcode) {
  return static_cast<unsigned>(opcode) >= 8;
}

std::uint64_t big_endian(std::span<const std::byte> bytes) {
  std::uint64_t out = 0;
  for (const std::byte b : bytes) out = out << 8 | std::to_integer<std::uint64_t>(b);
  return out;
}

}  // namespace

std::vector<std::byte> masked_frame(Opcode opcode, std::span<const std::byte> payload, std::uint32_t mask) {
  std::vector<std::byte> out;
  out.reserve(14 + payload.size());
  const auto put = [&](std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::byte>(value >> (8 * i)));
  };
  put(0x80U | static_cast<unsigned>(opcode), 1);
  if (payload.size() < 126) {
    put(0x80U | payload.size(), 1);
  } else if (payload.size() < 65536) {
    put(0x80U | 126U, 1);
    put(payload.size(), 2);
  } else {
    put(0x80U | 127U, 1);
    put(payload.size(), 8);
  }
  put(mask, 4);
  for (std::size_t i = 0; i < payload.size(); ++i) {
    out.push_back(payload[i] ^ static_cast<std::byte>(mask >> (8 * (3 - i % 4))));
  }
  return out;
}

/// Collects the head of a frame; true when it is whole.
bool FrameReader::read_head() {
  const auto needed = [&]() -> std::size_t {
    if (head_size_ < 2) return 2;
    const unsigned length = std::to_integer<unsigned>(head_[1]) & 0x7FU;
    return length == 126 ? 4 : length == 127 ? 10 : 2;
  };
  while (head_size_ < needed()) {
    if (input_.empty()) return false;
    head_[head_size_++] = input_.front();
    input_ = input_.subspan(1);
  }
  const auto first = std::to_integer<unsigned>(head_[0]);
  const unsigned length = std::to_integer<unsigned>(head_[1]) & 0x7FU;
  is_final_ = (first & 0x80U) != 0;
  opcode_ = static_cast<Opcode>(first & 0x0FU);
  remaining_ = length < 126 ? length : big_endian(std::span(head_).subspan(2, head_size_ - 2));
  return true;
}

std::optional<std::string_view> FrameReader::head_fault() const {
  if ((std::to_integer<unsigned>(head_[0]) & 0x70U) != 0) return "a frame uses an extension that was not agreed on";
  if ((std::to_integer<unsigned>(head_[1]) & 0x80U) != 0) return "a frame of the server is masked";
  switch (opcode_) {
    case Opcode::kClose:
    case Opcode::kPing:
    case Opcode::kPong:
      if (!is_final_ || remaining_ > kControlBytesMax) return "a control frame is fragmented or too long";
      return std::nullopt;
    case Opcode::kContinuation:
      if (!in_message_) return "a continuation continues nothing";
      break;
    case Opcode::kBinary:
      if (in_message_) return "a message begins inside another";
      break;
    default:
      return "a frame is neither binary nor control";
  }
  const std::size_t held = is_message_done_ ? 0 : message_.size();
  if (remaining_ > message_bytes_max_ - std::min(held, message_bytes_max_)) return "a message is too long";
  return std::nullopt;
}

void FrameReader::begin_payload() {
  in_payload_ = true;
  if (is_control(opcode_)) {
    control_.clear();
    return;
  }
  if (is_message_done_) {
    message_.clear();
    is_message_done_ = false;
  }
  in_message_ = true;
  message_.reserve(message_.size() + static_cast<std::size_t>(remaining_));
}

std::optional<FrameReader::Event> FrameReader::end_frame() {
  in_payload_ = false;
  head_size_ = 0;
  Event event;
  switch (opcode_) {
    case Opcode::kPing:
      event.kind = Event::Kind::kPing;
      event.bytes = control_;
      return event;
    case Opcode::kPong:
      event.kind = Event::Kind::kPong;
      event.bytes = control_;
      return event;
    case Opcode::kClose:
      event.kind = Event::Kind::kClose;
      event.bytes = control_;
      if (control_.size() >= 2) event.close_code = static_cast<std::uint16_t>(big_endian(std::span(control_).first(2)));
      return event;
    default:
      break;
  }
  if (!is_final_) return std::nullopt;
  in_message_ = false;
  is_message_done_ = true;
  event.bytes = message_;
  return event;
}

FrameReader::Event FrameReader::fault(std::string_view what) {
  fault_ = what;
  Event event;
  event.kind = Event::Kind::kFault;
  event.fault = what;
  return event;
}

std::optional<FrameReader::Event> FrameReader::next() {
  if (!fault_.empty()) return std::nullopt;
  for (;;) {
    if (!in_payload_) {
      if (!read_head()) return std::nullopt;
      if (const auto what = head_fault()) return fault(*what);
      begin_payload();
    }
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(remaining_, input_.size()));
    std::vector<std::byte>& into = is_control(opcode_) ? control_ : message_;
    into.insert(into.end(), input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(size));
    input_ = input_.subspan(size);
    remaining_ -= size;
    if (remaining_ > 0) return std::nullopt;
    if (std::optional<Event> event = end_frame()) return event;
  }
}

}  // namespace talus::client
