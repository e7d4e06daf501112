#include "server/net/channel.hpp"

#include <poll.h>
#include <sys/epoll.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace talus::server {

namespace {

/// What one TLS record holds at most.
constexpr std::size_t kRecordBytes = 16 * 1024;
/// Buffers of one gather write: what a batch of a stream's frames has at most.
constexpr std::size_t kBuffersAtOnce = 64;

/// What a peer has sent already is read without waiting so many times in a row; then it is another connection's turn.
constexpr int kReadsInARow = 16;

constexpr std::uint32_t kReadEvents = EPOLLIN | EPOLLPRI | EPOLLRDHUP | EPOLLHUP | EPOLLERR;
constexpr std::uint32_t kWriteEvents = EPOLLOUT | EPOLLHUP | EPOLLERR;
/// After one of these a read may stop short of more: of the end, or at an urgent byte.
constexpr std::uint32_t kShortEvents = EPOLLPRI | EPOLLRDHUP | EPOLLHUP | EPOLLERR;

/// The first `into.size()` bytes of all buffers together.
std::size_t gather(std::span<const asio::const_buffer> buffers, std::span<std::byte> into) {
  std::size_t filled = 0;
  for (const asio::const_buffer& buffer : buffers) {
    const std::size_t taken = std::min(buffer.size(), into.size() - filled);
    if (taken != 0) std::memcpy(into.data() + filled, buffer.data(), taken);
    filled += taken;
  }
  return filled;
}

bool would_block(int fault) {
  return fault == EAGAIN || fault == EWOULDBLOCK;
}

asio::error_code error_of(int fault) {
  if (would_block(fault)) return asio::error::would_block;
  return {fault, asio::error::get_system_category()};
}

}  // namespace

Channel::Channel(Poller& poller, Descriptor socket, const TlsContext* tls, Metrics& metrics)
    : poller_(poller),
      socket_(std::move(socket)),
      metrics_(metrics),
      readable_(poller.executor()),
      writable_(poller.executor()) {
  if (tls != nullptr) tls_ = tls->accept(socket_.number());
  poller_.add(socket_.number(), *this);
}

Channel::~Channel() {
  if (socket_.is_open()) poller_.remove(socket_.number());
}

void Channel::ready(std::uint32_t events) noexcept {
  const auto wanted = [&](TlsWant want) {
    return (events & (want == TlsWant::kWritable ? kWriteEvents : kReadEvents)) != 0;
  };
  if ((events & kShortEvents) != 0) is_short_read_last_ = false;
  if (wanted(write_want_)) {
    may_write_ = true;
    if (is_write_awaited_) writable_.ring();
  }
  if (!wanted(read_want_)) return;
  may_read_ = true;
  if (is_read_awaited_) {
    readable_.ring();
  } else if (reader_ != nullptr) {
    reader_->readable();
  }
}

Channel::Read Channel::read_now(std::span<std::byte> into) {
  if (!socket_.is_open()) return {asio::error::bad_descriptor, 0};
  if (tls_ != nullptr) return receive_record(into);
  if (!may_read_) return {asio::error::would_block, 0};
  return receive(into);
}

Channel::Read Channel::receive(std::span<std::byte> into) {
  for (;;) {
    const ssize_t got = receive_some(socket_.number(), into);
    if (got > 0) {
      const auto bytes = static_cast<std::size_t>(got);
      may_read_ = bytes == into.size() || !is_short_read_last_;
      return {{}, bytes};
    }
    if (got == 0) return {asio::error::eof, 0};
    if (errno == EINTR) continue;
    if (would_block(errno)) may_read_ = false;
    return {error_of(errno), 0};
  }
}

Channel::Read Channel::receive_record(std::span<std::byte> into) {
  may_read_ = false;
  const TlsProgress progress = tls_->read(into);
  note_handshake(progress.is_over);
  if (progress.is_over) return {asio::error::eof, 0};
  read_want_ = progress.want == TlsWant::kWritable ? TlsWant::kWritable : TlsWant::kReadable;
  if (progress.want == TlsWant::kNothing) return {{}, progress.bytes};
  return {asio::error::would_block, 0};
}

Awaitable<Channel::Read> Channel::read_some(std::span<std::byte> into) {
  for (;;) {
    const Read read = read_now(into);
    if (read.error != asio::error::would_block) {
      if (!read.error && ++reads_in_a_row_ % kReadsInARow == 0) co_await asio::post(executor(), kAwaitable);
      co_return read;
    }
    reads_in_a_row_ = 0;
    is_read_awaited_ = true;
    co_await readable_.wait();
    is_read_awaited_ = false;
  }
}

std::size_t Channel::write_some(std::span<const asio::const_buffer> buffers, asio::error_code& error) {
  error = {};
  if (!socket_.is_open()) {
    error = asio::error::bad_descriptor;
    return 0;
  }
  if (tls_ == nullptr) return write_clear(buffers, error);
  std::array<asio::const_buffer, kBuffersAtOnce> left;
  std::size_t count = 0;
  for (const asio::const_buffer& buffer : buffers.first(std::min(buffers.size(), left.size()))) {
    if (buffer.size() != 0) left[count++] = buffer;
  }
  std::size_t sent = 0;
  std::size_t first = 0;
  while (first < count) {
    std::size_t taken = write_record(std::span(left).subspan(first, count - first), error);
    if (error) break;
    sent += taken;
    while (first < count && taken >= left[first].size()) taken -= left[first++].size();
    if (first < count) left[first] += taken;
  }
  if (sent != 0) error = {};
  return sent;
}

std::size_t Channel::write_clear(std::span<const asio::const_buffer> buffers, asio::error_code& error) {
  std::array<iovec, kBuffersAtOnce> parts;
  msghdr message{};
  message.msg_iov = parts.data();
  for (const asio::const_buffer& buffer : buffers.first(std::min(buffers.size(), parts.size()))) {
    // The kernel only reads what a vector of its two directions cannot call const.
    if (buffer.size() != 0) parts[message.msg_iovlen++] = {const_cast<void*>(buffer.data()), buffer.size()};
  }
  for (;;) {
    const ssize_t sent = send_some(socket_.number(), message);
    if (sent >= 0) return static_cast<std::size_t>(sent);
    if (errno == EINTR) continue;
    if (would_block(errno)) may_write_ = false;
    error = error_of(errno);
    return 0;
  }
}

/// Small buffers go into one record together; a large one goes as it is.
std::size_t Channel::write_record(std::span<const asio::const_buffer> buffers, asio::error_code& error) {
  std::array<std::byte, kRecordBytes> record;
  std::span<const std::byte> bytes(static_cast<const std::byte*>(buffers[0].data()), buffers[0].size());
  if (bytes.size() >= record.size() || buffers.size() == 1) {
    bytes = bytes.first(std::min(bytes.size(), record.size()));
  } else {
    bytes = std::span(record).first(gather(buffers, record));
  }
  const TlsProgress progress = tls_->write(bytes);
  note_handshake(progress.is_over);
  write_want_ = progress.want == TlsWant::kReadable ? TlsWant::kReadable : TlsWant::kWritable;
  if (progress.is_over) {
    error = asio::error::connection_reset;
  } else if (progress.want != TlsWant::kNothing) {
    may_write_ = false;
    error = asio::error::would_block;
  }
  return progress.bytes;
}

Awaitable<asio::error_code> Channel::wait_writable() {
  while (socket_.is_open() && !may_write_) {
    is_write_awaited_ = true;
    co_await writable_.wait();
    is_write_awaited_ = false;
  }
  co_return socket_.is_open() ? asio::error_code{} : asio::error_code(asio::error::bad_descriptor);
}

void Channel::note_handshake(bool is_over) {
  if (is_handshake_noted_) return;
  const bool is_established = tls_->is_established();
  if (!is_established && !is_over) return;
  is_handshake_noted_ = true;
  metrics_.add(is_established ? Count::kTlsEstablished : Count::kTlsFailed);
}

void Channel::shutdown_send() {
  if (!socket_.is_open()) return;
  if (tls_ != nullptr) tls_->say_goodbye();
  ::shutdown(socket_.number(), SHUT_WR);
}

Awaitable<void> Channel::hear_out(std::size_t bytes_max) {
  shutdown_send();
  std::array<std::byte, 4096> dropped;
  for (std::size_t total = 0; total < bytes_max;) {
    const auto [error, got] = co_await read_some(dropped);
    if (error) break;
    total += got;
  }
}

void Channel::close() {
  if (!socket_.is_open()) return;
  if (tls_ != nullptr) {
    note_handshake(true);
    tls_->say_goodbye();
  }
  end();
}

void Channel::reset() {
  if (!socket_.is_open()) return;
  if (tls_ != nullptr) note_handshake(true);
  const linger at_once{1, 0};
  ::setsockopt(socket_.number(), SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
  end();
}

void Channel::end() {
  poller_.remove(socket_.number());
  socket_.close();
  readable_.ring();
  writable_.ring();
}

bool Channel::is_peer_gone() {
  if (!socket_.is_open()) return true;
  pollfd asked{socket_.number(), POLLRDHUP, 0};
  return ::poll(&asked, 1, 0) == 1 && (asked.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
}

}  // namespace talus::server
