// Starts an HTTP connection on an accepted socket. Asio's types stay out of most of the room's sources.
#pragma once

#include <memory>

#include "server/net/channel.hpp"
#include "server/net/connection_census.hpp"
#include "server/net/net_context.hpp"
#include "server/net/routes.hpp"
#include "server/net/sweeper.hpp"
#include "server/schedule/gate.hpp"

namespace talus::server {

/// What a connection holds as long as it lives, whatever it turns into.
struct ConnectionPass {
  Gate::Pass gate;
  ConnectionCensus::Place place;
  ClientId client = 0;  ///< of its address: what HTTP asks for is shared out by it
  PolicyRef policy;     ///< as it was when the connection came
  WholeAddress address{};
  bool is_proxy = false;  ///< one whose word on addresses is taken
};

/// Serves until the peer or a limit ends it. On the thread of `sweeper`, which is that of `channel`.
void start_http_connection(NetContext& net, Sweeper& sweeper, std::unique_ptr<Channel> channel, ConnectionPass pass,
                           Door door);

}  // namespace talus::server
