// A talusd of the benchmark's own, and what the system says it takes.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <vector>

namespace talus::bench {

class Served {
 public:
  /// Starts `program` on free ports of loopback and waits until it is ready. Throws when it does not get ready.
  Served(const std::string& program, const std::vector<std::string>& arguments);
  /// Stops it and waits for its end.
  ~Served();
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  const std::string& http() const { return http_; }
  const std::string& admin() const { return admin_; }
  std::size_t resident_bytes() const;  ///< of the process
  /// What the kernel holds for the server's ends of HTTP and WebSocket connections: sent and not acknowledged, received
  /// and not read, set aside (`ss -m`).
  std::size_t socket_bytes() const;
  /// A counter of /metrics, by the text before its value.
  double metric(const std::string& name) const;

 private:
  pid_t process_ = -1;
  std::string http_;
  std::string admin_;
};

/// Pages of TCP memory of the whole machine, both ends of every connection, in bytes (/proc/net/sockstat).
std::size_t machine_tcp_bytes();

}  // namespace talus::bench
