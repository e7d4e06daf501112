#include "client_sample/library/length_frames.hpp"

#include <algorithm>

namespace talus::client {

std::vector<std::byte> length_frame(std::span<const std::byte> message) {
  std::vector<std::byte> out;
  out.reserve(4 + message.size());
  for (unsigned i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(message.size() >> (8 * i)));
  out.insert(out.end(), message.begin(), message.end());
  return out;
}

std::optional<LengthReader::Event> LengthReader::next() {
  if (is_broken_) return std::nullopt;
  if (is_message_done_) {
    message_.clear();
    head_size_ = 0;
    is_message_done_ = false;
  }
  while (head_size_ < head_.size()) {
    if (input_.empty()) return std::nullopt;
    head_[head_size_++] = input_.front();
    input_ = input_.subspan(1);
    if (head_size_ < head_.size()) continue;
    message_bytes_ = 0;
    for (std::size_t i = head_.size(); i-- > 0;) {
      message_bytes_ = message_bytes_ << 8 | std::to_integer<std::size_t>(head_[i]);
    }
    if (message_bytes_ > message_bytes_max_) {
      is_broken_ = true;
      Event event;
      event.kind = Event::Kind::kFault;
      event.fault = "a message is too long";
      return event;
    }
    message_.reserve(message_bytes_);
  }
  const std::size_t size = std::min(input_.size(), message_bytes_ - message_.size());
  message_.insert(message_.end(), input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(size));
  input_ = input_.subspan(size);
  if (message_.size() < message_bytes_) return std::nullopt;
  is_message_done_ = true;
  Event event;
  event.bytes = message_;
  return event;
}

}  // namespace talus::client
