// Where a server is. Pure.
#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

#include "client_sample/library/client_error.hpp"

namespace talus::client {

/// What carries the messages of a stream.
enum class Carrier : std::uint8_t {
  kWebSocket,  ///< on the server's HTTP port
  kTcp,        ///< on its own port; no HTTP there
};

struct ServerAddress {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;
  std::string prefix;  ///< path before /v1, without a slash at its end; none with kTcp
  Carrier carrier = Carrier::kWebSocket;
  bool is_secure = false;  ///< TLS
  std::string ca_file{};   ///< PEM of the authorities to trust; empty: the system's
  std::string token{};     ///< for servers that let only some in: goes with every request, and into the hello

  /// "host:port" as the Host field has it; IPv6 in brackets.
  std::string authority() const;
  /// The head line that brings the token, with its CR LF; nothing without one.
  std::string authorization() const { return token.empty() ? "" : "Authorization: Bearer " + token + "\r\n"; }
};

/// "http://host[:port][/prefix]" (or ws; port 80), "https://..." (or wss; 443), "tcp://host[:port]" or "tls://..."
/// (8081, the server's --tcp-listen).
std::expected<ServerAddress, ClientError> parse_server_url(std::string_view url);

}  // namespace talus::client
