#include "server/net/poller.hpp"

#include <sys/epoll.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace talus::server {

namespace {

constexpr int kEventsAtOnce = 64;
/// So many edges are told for one turn of the io_context, each a few microseconds' work, before others have theirs.
constexpr int kEventsPerTurn = 256;

}  // namespace

Poller::Poller(asio::io_context& context) : epoll_(context.get_executor()) {
  const int descriptor = ::epoll_create1(EPOLL_CLOEXEC);
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "epoll_create1");
  epoll_.assign(descriptor);
}

void Poller::start() {
  epoll_.async_wait(epoll_.wait_read, [this](const asio::error_code& error) {
    if (error) return;
    tell();
    start();
  });
}

void Poller::stop() {
  asio::error_code ignored;
  epoll_.close(ignored);
}

void Poller::add(int descriptor, Polled& who) {
  const auto place = static_cast<std::size_t>(descriptor);
  if (polled_.size() <= place) polled_.resize(place + 1);
  polled_[place] = &who;
  epoll_event event{};
  event.events = EPOLLIN | EPOLLOUT | EPOLLPRI | EPOLLRDHUP | EPOLLET;
  event.data.fd = descriptor;
  if (::epoll_ctl(epoll_.native_handle(), EPOLL_CTL_ADD, descriptor, &event) == 0) return;
  const int fault = errno;
  polled_[place] = nullptr;
  throw std::system_error(fault, std::generic_category(), "epoll_ctl");
}

/// The set forgets a descriptor by itself when it is closed.
void Poller::remove(int descriptor) {
  polled_[static_cast<std::size_t>(descriptor)] = nullptr;
}

void Poller::tell() {
  std::array<epoll_event, kEventsAtOnce> events;
  for (int told = 0; told < kEventsPerTurn;) {
    const int count = ::epoll_wait(epoll_.native_handle(), events.data(), kEventsAtOnce, 0);
    for (int i = 0; i < count; ++i) {
      const epoll_event& event = events[static_cast<std::size_t>(i)];
      if (Polled* who = polled_[static_cast<std::size_t>(event.data.fd)]) who->ready(event.events);
    }
    // Where several came at once more will have come meanwhile; one by one they are cheaper to wait for.
    if (count <= 1) return;
    told += count;
  }
}

}  // namespace talus::server
