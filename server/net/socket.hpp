// What of Asio the net room uses, spelled once, and descriptors of sockets.
//
// Errors come back as values. Awaitables are awaited on the thread of their connection only: every connection belongs
// to one single-threaded io_context for its life, so nothing inside a connection is locked.
#pragma once

#include <asio/awaitable.hpp>
#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/experimental/as_tuple.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <asio/use_awaitable.hpp>

#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <span>
#include <utility>

namespace talus::server {

using Acceptor = asio::basic_socket_acceptor<asio::ip::tcp, asio::io_context::executor_type>;
using Timer = asio::basic_waitable_timer<std::chrono::steady_clock, asio::wait_traits<std::chrono::steady_clock>,
                                         asio::io_context::executor_type>;
template <typename T>
using Awaitable = asio::awaitable<T, asio::io_context::executor_type>;

inline constexpr asio::use_awaitable_t<asio::io_context::executor_type> kAwaitable{};
/// `const auto [error] = co_await timer.async_wait(kAwait);`
inline constexpr auto kAwait = asio::experimental::as_tuple_t<asio::use_awaitable_t<asio::io_context::executor_type>>{};

/// A timer used as a bell: waits for ever, and is rung by cancelling it.
class Bell {
 public:
  explicit Bell(const asio::io_context::executor_type& executor) : timer_(executor, Timer::time_point::max()) {}
  Awaitable<void> wait() { co_await timer_.async_wait(kAwait); }
  void ring() { timer_.cancel(); }

 private:
  Timer timer_;
};

/// Owns a descriptor; -1 for none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  void close() {
    if (is_open()) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

/// recv(2) and sendmsg(2) with MSG_NOSIGNAL. Those of glibc are points where a thread may be cancelled, at two locked
/// exchanges a call once there are several threads; nobody cancels threads here.
ssize_t receive_some(int descriptor, std::span<std::byte> into);
ssize_t send_some(int descriptor, const msghdr& message);

/// Options of every accepted socket; failures are left to the first read.
void set_socket_options(int descriptor);

}  // namespace talus::server
