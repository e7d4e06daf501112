#include <algorithm>

#include "server/net/framing.hpp"

namespace talus::server {

namespace {

constexpr std::size_t kHeadBytes = 4;

class TcpFraming final : public Framing {
 public:
  explicit TcpFraming(std::size_t message_bytes_max) : message_bytes_max_(message_bytes_max) {}

  void feed(std::span<const std::byte> bytes) override { input_ = bytes; }

  std::optional<Inbound> next() override {
    if (is_whole_) empty_message(message_);
    is_whole_ = false;
    while (!input_.empty()) {
      if (head_size_ < kHeadBytes) {
        head_[head_size_++] = input_.front();
        input_ = input_.subspan(1);
        if (head_size_ < kHeadBytes) continue;
        message_bytes_ = 0;
        for (std::size_t i = kHeadBytes; i-- > 0;)
          message_bytes_ = message_bytes_ << 8 | std::to_integer<std::size_t>(head_[i]);
        if (message_bytes_ > message_bytes_max_) {
          return Inbound{Inbound::Kind::kFault, {}, CloseCode::kTooBig, "the declared message is too large"};
        }
      } else {
        const std::size_t taken = std::min(input_.size(), message_bytes_ - message_.size());
        message_.insert(message_.end(), input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(taken));
        input_ = input_.subspan(taken);
      }
      if (message_.size() == message_bytes_) {
        head_size_ = 0;
        is_whole_ = true;
        return Inbound{Inbound::Kind::kMessage, message_, CloseCode::kNormal, {}};
      }
    }
    return std::nullopt;
  }

  bool is_between_messages() const override { return head_size_ == 0; }

  FrameHead message_head(std::size_t message_bytes) const override {
    FrameHead head;
    for (; head.size < kHeadBytes; ++head.size)
      head.bytes[head.size] = static_cast<std::byte>(message_bytes >> (8 * head.size));
    return head;
  }

  std::vector<std::byte> ping() const override { return {}; }
  std::vector<std::byte> pong(std::span<const std::byte>) const override { return {}; }
  std::vector<std::byte> close(CloseCode, std::string_view) const override { return {}; }

 private:
  const std::size_t message_bytes_max_;
  std::span<const std::byte> input_;
  std::array<std::byte, kHeadBytes> head_{};
  std::size_t head_size_ = 0;
  std::size_t message_bytes_ = 0;
  std::vector<std::byte> message_;
  bool is_whole_ = false;
};

}  // namespace

std::unique_ptr<Framing> make_tcp_framing(std::size_t message_bytes_max) {
  return std::make_unique<TcpFraming>(message_bytes_max);
}

}  // namespace talus::server
