// Whose pages may read a server: the Origin that a browser says of itself. Immutable; any thread.
#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus::server {

class AllowedOrigins {
 public:
  /// "https://maps.example.org", "http://127.0.0.1:5173": scheme and authority, as browsers write them. Without any
  /// every page may read. The error names the text.
  static std::expected<AllowedOrigins, std::string> parse(std::span<const std::string> texts);

  bool empty() const { return origins_.empty(); }
  /// What has no Origin is no page, and may.
  bool admits(std::optional<std::string_view> origin) const { return !origin || !allow_field(origin).empty(); }
  /// For Access-Control-Allow-Origin: "*", the origin itself when it is listed, or nothing. Lives as long as this.
  std::string_view allow_field(std::optional<std::string_view> origin) const;

 private:
  std::vector<std::string> origins_;
};

}  // namespace talus::server
