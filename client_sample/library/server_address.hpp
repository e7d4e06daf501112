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

  /// "host:port" as the Host field has it; IPv6 in brackets.
  std::string authority() const;
};

/// "http://host[:port][/prefix]" (port 80) or "tcp://host[:port]" (port 8081, the server's --tcp-listen). https is not
/// spoken: put a proxy on the client's side or use a browser.
std::expected<ServerAddress, ClientError> parse_server_url(std::string_view url);

}  // namespace talus::client
