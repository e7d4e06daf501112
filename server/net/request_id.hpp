// What a request is called in the log and in its answer: its own X-Request-Id, if that is fit to be written, or one
// made here. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/hash.hpp"
#include "server/schedule/clock.hpp"

namespace talus::server {

/// Letters, digits and what identifiers of other programs are made of (UUID, traceparent, Root=1-...), 1 to 64.
inline bool is_request_id(std::string_view text) {
  constexpr std::size_t kBytesMax = 64;
  constexpr std::string_view kMarks = "-._:+/=";
  const auto is_fit = [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           kMarks.find(c) != std::string_view::npos;
  };
  return !text.empty() && text.size() <= kBytesMax && std::all_of(text.begin(), text.end(), is_fit);
}

/// Sixteen hexadecimal digits.
inline std::array<char, 16> hex_digits(std::uint64_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<char, 16> out{};
  for (std::size_t i = out.size(); i-- > 0; value >>= 4U) out[i] = kDigits[value & 15U];
  return out;
}

/// The names of one connection's requests. Owner: the connection.
class RequestIds {
 public:
  /// `connection` is its number in this process, `opened` tells processes apart.
  RequestIds(std::uint64_t connection, Instant opened)
      : base_(mix64(static_cast<std::uint64_t>(opened.time_since_epoch().count()), connection)) {}

  /// Good until the next is made.
  std::string_view next() {
    made_ = hex_digits(mix64(base_, ++requests_));
    return {made_.data(), made_.size()};
  }
  /// What the peer calls it, as long as its bytes are there, or one of ours.
  std::string_view of(const std::optional<std::string_view>& given) {
    return given && is_request_id(*given) ? *given : next();
  }

 private:
  const std::uint64_t base_;
  std::uint64_t requests_ = 0;
  std::array<char, 16> made_{};
};

}  // namespace talus::server
