#include "server/net/allowed_origins.hpp"

#include <algorithm>

namespace talus::server {

namespace {

bool is_origin(std::string_view text) {
  const std::size_t scheme = text.find("://");
  if (scheme == std::string_view::npos || scheme == 0) return false;
  const std::string_view authority = text.substr(scheme + 3);
  const bool is_printable = std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < '\x7F'; });
  return is_printable && !authority.empty() && authority.find_first_of("/?#@*") == std::string_view::npos;
}

}  // namespace

std::expected<AllowedOrigins, std::string> AllowedOrigins::parse(std::span<const std::string> texts) {
  AllowedOrigins out;
  for (const std::string& text : texts) {
    if (!is_origin(text))
      return std::unexpected("'" + text + "': expected an origin, such as https://maps.example.org");
    out.origins_.push_back(text);
  }
  return out;
}

std::string_view AllowedOrigins::allow_field(std::optional<std::string_view> origin) const {
  if (origins_.empty()) return "*";
  if (!origin) return {};
  const auto found = std::find(origins_.begin(), origins_.end(), *origin);
  return found == origins_.end() ? std::string_view{} : std::string_view(*found);
}

}  // namespace talus::server
