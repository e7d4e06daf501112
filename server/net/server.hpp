// The network threads and the listening sockets: start, drain, stop.
//
// One io_context a thread, each run by that thread alone, so a connection needs no locks. One acceptor gives its
// sockets out in turn: streams last for hours, and a hash of addresses (SO_REUSEPORT) would leave threads unevenly
// loaded for as long; it would also let a second server bind the same port without an error.
#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string>

#include "server/net/endpoint.hpp"
#include "server/net/net_context.hpp"

namespace talus::server {

enum class Listen : std::uint8_t { kHttp, kTcp, kAdmin };

enum class Signal : std::uint8_t { kStop, kReload };

class NetServer {
 public:
  /// `net` must outlive the server. Nothing listens and no thread runs yet.
  NetServer(NetContext& net, std::size_t threads);
  /// Stops at once if it was not stopped.
  ~NetServer();
  NetServer(const NetServer&) = delete;
  NetServer& operator=(const NetServer&) = delete;

  /// Binds, and says the address it got ("127.0.0.1:43210") or why not ("127.0.0.1:80: Permission denied"). With
  /// `is_tls` only TLS is spoken there, under the certificate of `net`.
  std::expected<std::string, std::string> listen(Listen kind, const Endpoint& endpoint, bool is_tls);
  /// Runs the threads. SIGINT and SIGTERM (kStop) and SIGHUP (kReload) call `on_signal`, on a network thread.
  void start(std::function<void(Signal)> on_signal);
  /// Stops accepting, lets answers and sessions end, after `seconds_max` ends them by force; then joins the threads.
  /// Not from a network thread.
  void stop(double seconds_max);

 private:
  struct Threads;
  NetContext& net_;
  std::unique_ptr<Threads> threads_;
};

}  // namespace talus::server
