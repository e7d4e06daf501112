// Which sockets of one thread can be read or written: an epoll set of our own, which the thread's io_context watches
// as one descriptor.
//
// Problem: Asio reads once more after every answer, only to hear that nothing is there, and each wait passes its queue
// and its locks, which is a good part of what a cached chunk costs. Answer: edges are told straight from
// epoll_wait to the socket's owner, many of them for one turn of the io_context. Owner: the thread of its io_context.
#pragma once

#include <asio/posix/basic_stream_descriptor.hpp>

#include <cstdint>
#include <vector>

#include "server/net/socket.hpp"

namespace talus::server {

/// Who is told of one socket.
class Polled {
 public:
  Polled() = default;
  Polled(const Polled&) = delete;
  Polled& operator=(const Polled&) = delete;

  /// `events` of epoll since the last call: an edge. Only a hint, as everything that is told late; throws nothing.
  virtual void ready(std::uint32_t events) noexcept = 0;

 protected:
  ~Polled() = default;
};

class Poller {
 public:
  explicit Poller(asio::io_context& context);

  /// Tells from the next turn of the io_context on, until `stop`.
  void start();
  void stop();

  /// `who` is told of `descriptor`, first of what it can do already, until `remove`, which comes before its closing.
  void add(int descriptor, Polled& who);
  void remove(int descriptor);
  asio::io_context::executor_type executor() { return epoll_.get_executor(); }

 private:
  void tell();

  asio::posix::basic_stream_descriptor<asio::io_context::executor_type> epoll_;
  /// By descriptor: an edge that waits to be told while its socket is closed finds nobody, or the number's new owner,
  /// who takes it for a hint.
  std::vector<Polled*> polled_;
};

}  // namespace talus::server
