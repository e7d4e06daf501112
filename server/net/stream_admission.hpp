// Whether a request becomes a stream: what it says itself, and what its connection knows of it.
#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "server/net/http_answer.hpp"
#include "server/net/http_connection.hpp"

namespace talus::server {

/// The head that makes the request with this `head` a WebSocket, or the refusal: for its form, for the page that asks,
/// or, behind a proxy, for the streams of the one who is served; `pass` then holds the new one's place among them.
/// `head` is one that can be parsed.
std::expected<std::string, HttpAnswer> stream_handshake(NetContext& net, ConnectionPass& pass, std::string_view head,
                                                        std::string_view request_id);

}  // namespace talus::server
