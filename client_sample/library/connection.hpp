// A connection to a talus server that carries whole messages, over WebSocket or plain TCP as the address says.
//
// Nothing here starts a thread: all callbacks run inside Loop::poll or Loop::run_for, on the thread that calls them, so
// an engine polls once a frame and needs no lock. Owner: the thread of the loop.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client_sample/library/client_error.hpp"
#include "client_sample/library/server_address.hpp"

namespace asio {
class io_context;
}

namespace talus::client {

/// Where connections wait. Outlives every Connection made on it.
class Loop {
 public:
  Loop();
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// Runs what is due and returns at once.
  void poll();
  /// Runs what is due and what becomes due within `time`; sleeps in between.
  void run_for(std::chrono::milliseconds time);

  asio::io_context& context() { return *context_; }

 private:
  std::unique_ptr<asio::io_context> context_;
};

class Connection {
 public:
  struct Handlers {
    std::function<void()> on_open;
    std::function<void(std::span<const std::byte>)> on_message;  ///< one whole message; bytes live during the call
    std::function<void(const ClientError&)> on_closed;           ///< once, and nothing after it
  };
  /// From resolving to an open connection; then the longest silence, which the server's pings break every 20 s.
  static constexpr std::chrono::seconds kOpenTimeout{10};
  static constexpr std::chrono::seconds kSilenceMax{60};

  /// Connects in the background. `target` is the path, as "/v1/worlds/default/stream"; plain TCP has no paths.
  Connection(Loop& loop, const ServerAddress& server, std::string target, Handlers handlers);
  /// Drops the connection; no callback runs any more. Not from inside a callback.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Queues a message. Before the connection is open, and after it has closed, it is dropped.
  void send(std::vector<std::byte> message);
  /// Says goodbye and closes; on_closed still comes.
  void close();
  /// Reads no more, for good, and only waits for the peer to give up: what a test of a server calls a stalled reader.
  void stall();

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace talus::client
