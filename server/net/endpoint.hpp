// Where to listen, as people write it. Pure.
#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace talus::server {

struct Endpoint {
  std::string address;
  std::uint16_t port = 0;
};

/// "127.0.0.1:8080", "[::1]:0"; an address, not a name.
std::expected<Endpoint, std::string> parse_endpoint(std::string_view text);

}  // namespace talus::server
