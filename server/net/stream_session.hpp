// Starts a streaming session on a socket that has become one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/net/framing.hpp"
#include "server/net/http_connection.hpp"

namespace talus::server {

struct StreamStart {
  std::unique_ptr<Framing> framing;
  std::optional<std::size_t> world;  ///< named by the URL; else the hello names it
  std::vector<std::byte> received;   ///< bytes behind the handshake
  bool is_admitted = false;          ///< by its URL; else the hello brings the token, if one is needed
  std::string request_id;            ///< what its log lines are found by
};

/// On the thread of `sweeper`, which is that of `channel`.
void start_stream_session(NetContext& net, Sweeper& sweeper, std::unique_ptr<Channel> channel, ConnectionPass pass,
                          StreamStart start);

}  // namespace talus::server
