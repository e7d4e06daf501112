// What a connection has received and not answered, from the first byte of a request's head on. Owner: one connection.
#pragma once

#include <cstddef>
#include <cstring>
#include <expected>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "server/net/http_request.hpp"

namespace talus::server {

class HeadBuffer {
 public:
  explicit HeadBuffer(const NetLimits& limits) : scanner_(limits) {}

  /// For what comes next. The scanner refuses a head before it grows beyond its limits, and memory with it.
  std::span<std::byte> room() {
    if (bytes_.size() < size_ + kReadBytes) bytes_.resize(size_ + kReadBytes);
    return std::as_writable_bytes(std::span(bytes_).subspan(size_));
  }
  /// So many bytes of the room were filled.
  void receive(std::size_t bytes) {
    // An empty line before a request is ignored (RFC 9112, 2.2); more of them are not.
    const std::size_t skipped = size_ == 0 && bytes >= 2 && bytes_[0] == '\r' && bytes_[1] == '\n' ? 2 : 0;
    size_ += bytes;
    if (skipped != 0) drop(skipped);
  }
  bool empty() const { return size_ == 0; }
  /// The length of the first head, nothing while it is not complete, or why it never can be.
  std::expected<std::optional<std::size_t>, HttpFault> head_bytes() {
    return scanner_.scan(std::string_view(bytes_.data(), size_));
  }
  std::string_view first(std::size_t bytes) const { return {bytes_.data(), bytes}; }
  std::span<const std::byte> behind(std::size_t bytes) const {
    return std::as_bytes(std::span(bytes_).subspan(bytes, size_ - bytes));
  }
  /// The first bytes are done with; a head begins behind them.
  void drop(std::size_t bytes) {
    size_ -= bytes;
    if (size_ != 0) std::memmove(bytes_.data(), bytes_.data() + bytes, size_);
    scanner_.reset();
  }

 private:
  static constexpr std::size_t kReadBytes = 4096;

  HeadScanner scanner_;
  std::vector<char> bytes_;  ///< [0, size_) is received
  std::size_t size_ = 0;
};

}  // namespace talus::server
