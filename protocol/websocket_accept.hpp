// The one hash of RFC 6455's opening handshake, for both ends. Pure.
#pragma once

#include <string>
#include <string_view>

namespace talus::protocol {

/// Sec-WebSocket-Accept for a Sec-WebSocket-Key: base64(SHA-1(key + GUID)), RFC 6455 section 4.2.2.
std::string websocket_accept(std::string_view key);

/// Base64 with padding, RFC 4648.
std::string base64(std::string_view bytes);

}  // namespace talus::protocol
