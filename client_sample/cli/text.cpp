#include "client_sample/cli/text.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace talus::cli {
namespace {

/// Splits at `separator` into exactly N numbers.
template <typename T, std::size_t N>
std::optional<std::array<T, N>> parse_numbers(std::string_view text, char separator) {
  std::array<T, N> out{};
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t end = i + 1 < N ? text.find(separator) : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + end, out[i]);
    if (error != std::errc{} || stop != text.data() + end) return std::nullopt;
    text.remove_prefix(i + 1 < N ? end + 1 : end);
  }
  return out;
}

}  // namespace

std::optional<ChunkKey> parse_chunk_key(std::string_view text) {
  const auto numbers = parse_numbers<std::int32_t, 4>(text, '/');
  if (!numbers) return std::nullopt;
  const ChunkKey key{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
  if (!is_valid(key)) return std::nullopt;
  return key;
}

std::string format_chunk_key(const ChunkKey& key) {
  return fmt::format("{}/{}/{}/{}", key.lod, key.x, key.y, key.z);
}

std::optional<glm::dvec3> parse_place(std::string_view text) {
  const auto numbers = parse_numbers<double, 3>(text, ',');
  if (!numbers) return std::nullopt;
  for (const double v : *numbers) {
    if (!std::isfinite(v)) return std::nullopt;
  }
  return glm::dvec3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

std::optional<glm::dvec2> parse_pair(std::string_view text) {
  const auto numbers = parse_numbers<double, 2>(text, ',');
  if (!numbers || !std::isfinite((*numbers)[0]) || !std::isfinite((*numbers)[1])) return std::nullopt;
  return glm::dvec2{(*numbers)[0], (*numbers)[1]};
}

std::optional<glm::ivec2> parse_size(std::string_view text) {
  const auto numbers = parse_numbers<int, 2>(text, 'x');
  if (!numbers || (*numbers)[0] < 1 || (*numbers)[1] < 1) return std::nullopt;
  return glm::ivec2{(*numbers)[0], (*numbers)[1]};
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

}  // namespace talus::cli
