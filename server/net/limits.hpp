// Every limit of the doors, with its default. Config keys of the same names: server/app/settings.
#pragma once

#include <cstddef>

#include "protocol/limits.hpp"

namespace talus::server {

struct NetLimits {
  // HTTP: beyond these 414, 431 or 413, and the connection closes.
  std::size_t request_line_bytes = 8 * 1024;
  std::size_t head_bytes = 16 * 1024;
  std::size_t head_fields = 64;
  std::size_t body_bytes = 64 * 1024;  ///< declared; no route reads a body
  std::size_t requests_per_connection = 10'000;

  double silent_s = 5;        ///< a new connection says nothing
  double head_s = 10;         ///< from the first byte of a head to its last, however the bytes are spread
  double idle_s = 30;         ///< between requests
  double write_stall_s = 10;  ///< no byte taken by the peer: reset
  double read_rate_min =
      1024;            ///< bytes a second a peer takes, over write_stall_s, while there is something for it; or reset
  double wait_s = 30;  ///< for a chunk that is being made: 503

  // Streams.
  double ping_s = 20;
  double gone_s = 45;
  std::size_t message_bytes = protocol::kInboundMessageBytesMax;
  double message_s = 15;  ///< from the first byte of a message to its last, however the bytes are spread
  double messages_per_s = 60;
  double message_burst = 120;
  std::size_t send_soft_bytes = 1024 * 1024;  ///< queued beyond this: chunks are taken back and asked for again
  std::size_t send_hard_bytes = 2048 * 1024;  ///< queued beyond this: reset
  std::size_t pongs_queued = 16;
  double view_far_m = protocol::kFarMax;  ///< a view is clamped to it
  std::size_t window_max = 16;            ///< chunks a session has in the making at once, shared fairly below that

  // Connections.
  std::size_t connections = 12'000;
  std::size_t connections_per_address = 64;
};

/// What the kernel may hold for one peer: SO_SNDBUF, and what of it may wait unsent. A stalled reader pins no more.
inline constexpr int kSocketSendBytes = 256 * 1024;
inline constexpr int kSocketUnsentBytes = 64 * 1024;

}  // namespace talus::server
