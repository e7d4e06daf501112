#include "server/net/channel.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace talus::server {

namespace {

/// What one TLS record holds at most.
constexpr std::size_t kRecordBytes = 16 * 1024;

/// What a peer has sent already is read without waiting so many times in a row; then it is another connection's turn.
constexpr int kReadsInARow = 16;

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

}  // namespace

Channel::Channel(Socket socket, const TlsContext* tls, Metrics& metrics)
    : socket_(std::move(socket)), metrics_(&metrics) {
  if (tls != nullptr) tls_ = tls->accept(socket_.native_handle());
}

Awaitable<Channel::Read> Channel::read_some(asio::mutable_buffer into) {
  if (tls_ == nullptr) {
    const auto [error, got] = co_await socket_.async_read_some(into, kAwait);
    co_return Read{error, got};
  }
  const std::span<std::byte> bytes(static_cast<std::byte*>(into.data()), into.size());
  // A closed descriptor's number may be another connection's already.
  while (socket_.is_open()) {
    const TlsProgress progress = tls_->read(bytes);
    note_handshake(progress.is_over);
    if (progress.is_over) break;
    if (progress.want == TlsWant::kNothing) {
      // A read in clear goes round the thread's queue by itself; one that OpenSSL has decrypted already does not.
      if (++reads_in_a_row_ % kReadsInARow == 0) co_await asio::post(socket_.get_executor(), kAwaitable);
      co_return Read{{}, progress.bytes};
    }
    reads_in_a_row_ = 0;
    const auto wait = progress.want == TlsWant::kReadable ? Socket::wait_read : Socket::wait_write;
    const auto [error] = co_await socket_.async_wait(wait, kAwait);
    if (error) co_return Read{error, 0};
  }
  co_return Read{asio::error::eof, 0};
}

std::size_t Channel::write_some(std::span<const asio::const_buffer> buffers, asio::error_code& error) {
  if (tls_ == nullptr) return socket_.write_some(buffers, error);
  std::array<asio::const_buffer, 2 * 64> left;
  std::size_t count = 0;
  for (const asio::const_buffer& buffer : buffers.first(std::min(buffers.size(), left.size()))) {
    if (buffer.size() != 0) left[count++] = buffer;
  }
  std::size_t sent = 0;
  std::size_t first = 0;
  error = {};
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

/// Small buffers go into one record together; a large one goes as it is.
std::size_t Channel::write_record(std::span<const asio::const_buffer> buffers, asio::error_code& error) {
  if (!socket_.is_open()) {
    error = asio::error::bad_descriptor;
    return 0;
  }
  std::array<std::byte, kRecordBytes> record;
  std::span<const std::byte> bytes(static_cast<const std::byte*>(buffers[0].data()), buffers[0].size());
  if (bytes.size() >= record.size() || buffers.size() == 1) {
    bytes = bytes.first(std::min(bytes.size(), record.size()));
  } else {
    bytes = std::span(record).first(gather(buffers, record));
  }
  const TlsProgress progress = tls_->write(bytes);
  note_handshake(progress.is_over);
  if (progress.is_over) {
    error = asio::error::connection_reset;
  } else if (progress.want != TlsWant::kNothing) {
    write_want_ = progress.want;
    error = asio::error::would_block;
  }
  return progress.bytes;
}

Awaitable<asio::error_code> Channel::wait_writable() {
  const auto wait = write_want_ == TlsWant::kReadable ? Socket::wait_read : Socket::wait_write;
  const auto [error] = co_await socket_.async_wait(wait, kAwait);
  co_return error;
}

void Channel::note_handshake(bool is_over) {
  if (is_handshake_noted_) return;
  const bool is_established = tls_->is_established();
  if (!is_established && !is_over) return;
  is_handshake_noted_ = true;
  metrics_->add(is_established ? Count::kTlsEstablished : Count::kTlsFailed);
}

void Channel::shutdown_send() {
  if (!socket_.is_open()) return;
  if (tls_ != nullptr) tls_->say_goodbye();
  asio::error_code ignored;
  socket_.shutdown(Socket::shutdown_send, ignored);
}

void Channel::close() {
  if (!socket_.is_open()) return;
  if (tls_ != nullptr) {
    note_handshake(true);
    tls_->say_goodbye();
  }
  asio::error_code ignored;
  socket_.close(ignored);
}

void Channel::reset() {
  if (tls_ != nullptr) note_handshake(true);
  asio::error_code ignored;
  socket_.set_option(asio::socket_base::linger(true, 0), ignored);
  socket_.close(ignored);
}

bool Channel::is_peer_gone() {
  if (!socket_.is_open()) return true;
  pollfd asked{socket_.native_handle(), POLLRDHUP, 0};
  return ::poll(&asked, 1, 0) == 1 && (asked.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
}

}  // namespace talus::server
