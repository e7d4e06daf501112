#include "server/net/url_text.hpp"

#include <charconv>
#include <cmath>

namespace talus::server {

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<std::int32_t> whole_number(std::string_view text) {
  std::string_view digits = text;
  if (digits.starts_with('-')) digits.remove_prefix(1);
  const bool has_leading_zero = digits.size() > 1 && digits.front() == '0';
  if (digits.empty() || has_leading_zero || text == "-0") return std::nullopt;
  std::int32_t value = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || at != end) return std::nullopt;
  return value;
}

std::optional<double> decimal_number(std::string_view text) {
  constexpr std::size_t kBytesMax = 40;
  constexpr std::string_view kAllowed = "0123456789+-.eE";
  if (text.empty() || text.size() > kBytesMax || text.find_first_not_of(kAllowed) != std::string_view::npos) {
    return std::nullopt;
  }
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || at != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::vector<double>> decimal_numbers(std::string_view text, std::size_t count) {
  std::vector<double> out;
  while (out.size() < count) {
    const std::size_t comma = text.find(',');
    const auto value = decimal_number(text.substr(0, comma));
    if (!value) return std::nullopt;
    out.push_back(*value);
    if (comma == std::string_view::npos) return out.size() == count ? std::optional(out) : std::nullopt;
    text.remove_prefix(comma + 1);
  }
  return std::nullopt;  // something follows the last number
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    unsigned value = 0;
    if (i + 2 >= text.size()) return std::nullopt;
    const auto [at, error] = std::from_chars(text.data() + i + 1, text.data() + i + 3, value, 16);
    if (error != std::errc{} || at != text.data() + i + 3) return std::nullopt;
    out += static_cast<char>(value);
    i += 2;
  }
  return out;
}

QueryValue query_value(std::string_view query, std::string_view name) {
  QueryValue found;
  while (!query.empty()) {
    const std::size_t end = query.find('&');
    const std::string_view pair = query.substr(0, end);
    query = end == std::string_view::npos ? std::string_view{} : query.substr(end + 1);
    const std::size_t equals = pair.find('=');
    if (pair.substr(0, equals) != name) continue;
    if (found.state != QueryState::kAbsent) return {QueryState::kTwice, {}};
    auto value = percent_decoded(equals == std::string_view::npos ? std::string_view{} : pair.substr(equals + 1));
    found = value ? QueryValue{QueryState::kPresent, std::move(*value)} : QueryValue{QueryState::kMalformed, {}};
  }
  return found;
}

std::optional<std::size_t> split_path(std::string_view path, std::span<std::string_view> out) {
  // Parts are shorter than what a call to find one's end costs.
  std::size_t count = 0;
  const char* begin = path.data();
  for (const char& c : path) {
    if (c != '/') continue;
    if (count == out.size()) return std::nullopt;
    out[count++] = {begin, static_cast<std::size_t>(&c - begin)};
    begin = &c + 1;
  }
  if (count == out.size()) return std::nullopt;
  out[count++] = {begin, static_cast<std::size_t>(path.data() + path.size() - begin)};
  return count;
}

}  // namespace talus::server
