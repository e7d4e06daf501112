// What every connection of the server shares. Owner: app; outlives every connection. Any thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "server/net/connection_census.hpp"
#include "server/net/net_policy.hpp"
#include "server/net/static_files.hpp"
#include "server/observe/metrics.hpp"
#include "server/schedule/clock.hpp"
#include "server/schedule/gate.hpp"
#include "server/schedule/job_pool.hpp"
#include "server/world/chunk_service.hpp"
#include "server/world/world.hpp"

namespace talus::server {

struct NetContext {
  const Worlds& worlds;
  const StaticFiles& files;
  const Clock& clock;
  ChunkService& chunks;
  JobPool& pool;
  Metrics& metrics;
  const std::string worlds_json;
  PolicySlot policy;  ///< of connections to come
  ConnectionCensus census;

  Gate connections;                      ///< one pass a connection; empty when the last has ended
  Gate admin_connections;                ///< those of the admin door, which is open until the end
  std::atomic<bool> is_ready{false};     ///< what /readyz says
  std::atomic<std::size_t> sessions{0};  ///< streams open
  std::atomic<std::uint64_t> session_numbers{0};
  std::atomic<std::uint64_t> request_numbers{0};  ///< connections that name requests
  std::atomic<std::size_t> queued_bytes{0};       ///< of frames that wait in all streams
};

inline Duration seconds(double s) {
  return Duration(static_cast<Duration::rep>(s * 1e9));
}

}  // namespace talus::server
