// RFC 6455, section 4.2: whether a request may become a WebSocket, and the answer that makes it one. Pure.
#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "server/net/http_answer.hpp"
#include "server/net/http_request.hpp"

namespace talus::server {

/// The whole answer, 101 and its fields, or the HTTP answer that says what is missing.
std::expected<std::string, HttpAnswer> websocket_handshake(const HttpRequest& request);

/// Sec-WebSocket-Accept for a key.
std::string websocket_accept(std::string_view key);

}  // namespace talus::server
