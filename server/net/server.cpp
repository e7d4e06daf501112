#include "server/net/server.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/ip/address.hpp>
#include <asio/signal_set.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <future>
#include <limits>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "server/net/connection_census.hpp"
#include "server/net/http_connection.hpp"
#include "server/net/poller.hpp"
#include "server/net/request_id.hpp"
#include "server/net/socket.hpp"
#include "server/net/stream_session.hpp"
#include "server/net/sweeper.hpp"
#include "server/observe/log.hpp"

namespace talus::server {

namespace {

using Executor = asio::io_context::executor_type;

constexpr std::string_view kFull =
    "HTTP/1.1 503 Service Unavailable\r\nContent-Type: application/json\r\nContent-Length: 63\r\nRetry-After: 5\r\n"
    "Connection: close\r\n\r\n{\"error\":\"busy\",\"message\":\"too many connections: come again\"}\r\n";

/// Connections taken in a row; then what else the thread has to do has its turn.
constexpr int kAcceptsInARow = 64;

struct IoThread {
  explicit IoThread(const Clock& clock) : poller(context), sweeper(context, clock), work(context.get_executor()) {}

  asio::io_context context{1};
  Poller poller;
  Sweeper sweeper;
  asio::executor_work_guard<Executor> work;
  std::thread thread;
};

struct Listener {
  Listener(const Executor& executor, Listen listen, bool with_tls)
      : acceptor(executor), kind(listen), is_tls(with_tls) {}
  Acceptor acceptor;
  const Listen kind;
  const bool is_tls;
};

/// A connection that has come, and whose it is.
struct Arrival {
  Descriptor socket;
  WholeAddress address{};
};

/// Takes one in; without a socket when none could be, and errno says why.
Arrival take_in(int listening) {
  sockaddr_storage from{};
  socklen_t size = sizeof(from);
  Arrival arrival;
  auto* const address = reinterpret_cast<sockaddr*>(&from);
  arrival.socket = Descriptor(::accept4(listening, address, &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (from.ss_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(from);
    std::memcpy(arrival.address.data(), &v6.sin6_addr, arrival.address.size());
  } else {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(from);
    const asio::ip::address_v4 mapped(ntohl(v4.sin_addr.s_addr));
    arrival.address = asio::ip::make_address_v6(asio::ip::v4_mapped, mapped).to_bytes();
  }
  return arrival;
}

void say_full(const Descriptor& socket) {
  ::send(socket.number(), kFull.data(), kFull.size(), MSG_NOSIGNAL);
}

/// A descriptor kept for the day when there are none: given up to take a connection in, tell it so and end it.
class SpareDescriptor {
 public:
  SpareDescriptor() { reopen(); }

  /// False when nobody was there, or the descriptor has gone to somebody else.
  bool refuse_one(int listening) {
    descriptor_.close();
    Arrival arrival = take_in(listening);
    const bool is_refused = arrival.socket.is_open();
    if (is_refused) say_full(arrival.socket);
    arrival.socket.close();
    reopen();
    return is_refused;
  }

 private:
  void reopen() { descriptor_ = Descriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC)); }
  Descriptor descriptor_;
};

}  // namespace

struct NetServer::Threads {
  Threads(NetContext& context, std::size_t count) : net(context) {
    for (std::size_t i = 0; i < count; ++i) io.push_back(std::make_unique<IoThread>(context.clock));
  }

  Executor front() { return io.front()->context.get_executor(); }
  Awaitable<void> accept_loop(Listener* listener);
  void welcome(const Listener& listener, Arrival arrival, IoThread& target);
  void wait_for_signal();
  void each_sweeper(void (Sweeper::*act)());
  void close_listeners(bool is_admin);

  NetContext& net;
  SpareDescriptor spare;
  std::vector<std::unique_ptr<IoThread>> io;
  std::vector<std::unique_ptr<Listener>> listeners;
  std::optional<asio::signal_set> signals;
  std::function<void(Signal)> on_signal;
  std::size_t next = 0;
  bool is_running = false;
};

NetServer::NetServer(NetContext& net, std::size_t threads)
    : net_(net), threads_(std::make_unique<Threads>(net, threads)) {}

NetServer::~NetServer() {
  stop(0.0);
}

std::expected<std::string, std::string> NetServer::listen(Listen kind, const Endpoint& endpoint, bool is_tls) {
  const asio::ip::tcp::endpoint wanted(asio::ip::make_address(endpoint.address), endpoint.port);
  auto listener = std::make_unique<Listener>(threads_->front(), kind, is_tls);
  Acceptor& acceptor = listener->acceptor;
  asio::error_code error;
  acceptor.open(wanted.protocol(), error);
  // Reuses a port whose old connections linger; one that somebody listens on is still an error.
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(wanted, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) acceptor.non_blocking(true, error);
  const auto name = [](const asio::ip::tcp::endpoint& at) {
    const std::string address = at.address().to_string();
    return (at.address().is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(at.port());
  };
  if (error) return std::unexpected("cannot listen on " + name(wanted) + ": " + error.message());
  std::string bound = name(acceptor.local_endpoint());
  threads_->listeners.push_back(std::move(listener));
  return bound;
}

void NetServer::start(std::function<void(Signal)> on_signal) {
  Threads& t = *threads_;
  t.on_signal = std::move(on_signal);
  t.signals.emplace(t.front(), SIGINT, SIGTERM, SIGHUP);
  t.wait_for_signal();
  for (const auto& listener : t.listeners) {
    asio::co_spawn(t.front(), t.accept_loop(listener.get()), [this](const std::exception_ptr& fault) {
      if (fault != nullptr) net_.metrics.add(Count::kConnectionFault);
    });
  }
  t.is_running = true;
  for (const auto& io : t.io) {
    io->poller.start();
    asio::co_spawn(io->context, io->sweeper.run(), [](const std::exception_ptr&) {});
    io->thread = std::thread([this, thread = io.get()] {
      for (;;) {
        try {
          thread->context.run();
          return;
        } catch (const std::exception& fault) {
          // A handler outside any connection's own care; the thread serves on.
          net_.metrics.add(Count::kConnectionFault);
          log(LogLevel::kError, "network thread fault", {{"fault", std::string_view(fault.what())}});
        }
      }
    });
  }
}

void NetServer::stop(double seconds_max) {
  Threads& t = *threads_;
  if (!std::exchange(t.is_running, false)) return;
  std::promise<void> emptied;
  std::promise<void> admin_emptied;
  std::future<void> is_empty = emptied.get_future();
  std::future<void> is_admin_empty = admin_emptied.get_future();
  asio::post(t.front(), [&t] { t.close_listeners(false); });
  net_.connections.close([&emptied] { emptied.set_value(); });
  t.each_sweeper(&Sweeper::drain);
  const auto wait = std::chrono::duration<double>(seconds_max);
  if (is_empty.wait_for(wait) != std::future_status::ready) {
    log(LogLevel::kWarning, "drain ran out of time", {{"connections", std::uint64_t{net_.connections.inside()}}});
  }
  asio::post(t.front(), [&t] {
    t.close_listeners(true);
    asio::error_code ignored;
    t.signals->cancel(ignored);
  });
  net_.admin_connections.close([&admin_emptied] { admin_emptied.set_value(); });
  t.each_sweeper(&Sweeper::abort);
  is_empty.wait();
  is_admin_empty.wait();
  t.each_sweeper(&Sweeper::stop);
  for (const auto& io : t.io) {
    asio::post(io->context, [&poller = io->poller] { poller.stop(); });
    io->work.reset();
    io->thread.join();
  }
}

void NetServer::Threads::each_sweeper(void (Sweeper::*act)()) {
  for (const auto& thread : io) {
    asio::post(thread->context, [&sweeper = thread->sweeper, act] { (sweeper.*act)(); });
  }
}

void NetServer::Threads::close_listeners(bool is_admin) {
  for (const auto& listener : listeners) {
    asio::error_code ignored;
    if ((listener->kind == Listen::kAdmin) == is_admin) listener->acceptor.close(ignored);
  }
}

void NetServer::Threads::wait_for_signal() {
  signals->async_wait([this](const asio::error_code& error, int number) {
    if (error) return;
    on_signal(number == SIGHUP ? Signal::kReload : Signal::kStop);
    wait_for_signal();
  });
}

Awaitable<void> NetServer::Threads::accept_loop(Listener* listener) {
  Acceptor& acceptor = listener->acceptor;
  Timer pause(acceptor.get_executor());
  while (acceptor.is_open()) {
    const auto [error] = co_await acceptor.async_wait(Acceptor::wait_read, kAwait);
    if (error) continue;  // it was closed
    bool is_short_of_something = false;
    for (int i = 0; i < kAcceptsInARow && acceptor.is_open(); ++i) {
      Arrival arrival = take_in(acceptor.native_handle());
      const int fault = errno;
      if (arrival.socket.is_open()) {
        welcome(*listener, std::move(arrival), *io[next++ % io.size()]);
      } else if ((fault == EMFILE || fault == ENFILE) && spare.refuse_one(acceptor.native_handle())) {
        net.metrics.add(Count::kConnectionsRefusedDescriptors);  // said whether or not anybody is there
      } else if (fault != ECONNABORTED && fault != EINTR) {
        is_short_of_something = fault != EAGAIN && fault != EWOULDBLOCK;
        break;
      }
    }
    if (is_short_of_something) {
      // Trying again at once would only burn the thread.
      pause.expires_after(std::chrono::milliseconds(50));
      co_await pause.async_wait(kAwait);
    }
  }
}

void NetServer::Threads::welcome(const Listener& listener, Arrival arrival, IoThread& target) {
  const Listen kind = listener.kind;
  const WholeAddress whole = arrival.address;
  const PeerAddress address = counted_address(whole);
  PolicyRef policy = net.policy.load();
  // A proxy speaks for many: those behind it are counted when their streams open.
  const bool is_proxy = policy->proxies.contains(whole);
  const std::size_t address_max =
      is_proxy ? std::numeric_limits<std::size_t>::max() : policy->limits.connections_per_address;
  auto [verdict, place] = net.census.enter(address, policy->limits.connections, address_max);
  if (verdict != ConnectionCensus::Verdict::kWelcome) {
    net.metrics.add(verdict == ConnectionCensus::Verdict::kTooMany ? Count::kConnectionsRefusedTotal
                                                                   : Count::kConnectionsRefusedAddress);
    if (kind != Listen::kTcp && !listener.is_tls) say_full(arrival.socket);
    return;
  }
  ConnectionPass pass{(kind == Listen::kAdmin ? net.admin_connections : net.connections).enter(),
                      std::move(place),
                      client_of_address(address),
                      std::move(policy),
                      whole,
                      is_proxy};
  if (!pass.gate) return;
  net.metrics.add(Count::kConnectionsAccepted);
  set_socket_options(arrival.socket.number());
  const TlsContext* tls = listener.is_tls ? pass.policy->tls.get() : nullptr;
  asio::post(target.context,
             [this, kind, &target, tls, socket = std::move(arrival.socket), pass = std::move(pass)]() mutable {
               auto channel = std::make_unique<Channel>(target.poller, std::move(socket), tls, net.metrics);
               if (kind == Listen::kTcp) {
                 StreamStart start;
                 start.framing = make_tcp_framing(pass.policy->limits.message_bytes);
                 RequestIds ids(net.request_numbers.fetch_add(1, std::memory_order_relaxed), net.clock.now());
                 start.request_id = ids.next();
                 start_stream_session(net, target.sweeper, std::move(channel), std::move(pass), std::move(start));
               } else {
                 const Door door = kind == Listen::kAdmin ? Door::kAdmin : Door::kPublic;
                 start_http_connection(net, target.sweeper, std::move(channel), std::move(pass), door);
               }
             });
}

}  // namespace talus::server
