// RFC 6455 section 4.1: how a client asks for a WebSocket and checks the answer. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "client_sample/library/client_error.hpp"
#include "client_sample/library/server_address.hpp"

namespace talus::client {

inline constexpr std::size_t kHandshakeBytesMax = 16 * 1024;

/// Sec-WebSocket-Key of 16 random bytes.
std::string handshake_key(std::uint64_t random_low, std::uint64_t random_high);
std::string handshake_request(const ServerAddress& server, std::string_view target, std::string_view key);
/// Why `answer` (a whole head, and what came behind it) is not the WebSocket that was asked for; nothing if it is.
std::optional<ClientError> handshake_fault(std::string_view answer, std::string_view key);

}  // namespace talus::client
