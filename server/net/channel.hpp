// Bytes to and from one peer, in clear or through TLS; connections do not know which.
//
// The shape is that of a non-blocking socket: a write is tried at once and waited for only when the kernel is full.
// Owner: one connection, on its thread. Everything that is awaited ends with an error once the channel is closed.
#pragma once

#include <memory>
#include <span>

#include "server/net/socket.hpp"
#include "server/net/tls.hpp"
#include "server/observe/metrics.hpp"

namespace talus::server {

class Channel {
 public:
  /// In clear when `tls` is nullptr. `metrics` must outlive the channel.
  Channel(Socket socket, const TlsContext* tls, Metrics& metrics);

  struct Read {
    asio::error_code error;
    std::size_t bytes = 0;
  };
  /// Some bytes, or why there are none. A TLS handshake is part of the first read.
  Awaitable<Read> read_some(asio::mutable_buffer into);
  /// The socket itself, for reads without a coroutine in between; nullptr when TLS lies between.
  Socket* in_clear() { return tls_ == nullptr ? &socket_ : nullptr; }
  /// As much as is taken at once; `would_block` when nothing is. What follows the returned bytes must come first in the
  /// next call.
  std::size_t write_some(std::span<const asio::const_buffer> buffers, asio::error_code& error);
  /// After `would_block`: until a write is worth trying.
  Awaitable<asio::error_code> wait_writable();

  /// Nothing more will be written; reading goes on.
  void shutdown_send();
  void close();
  /// Ends the connection at once; what was not taken is lost (SO_LINGER 0).
  void reset();
  /// Whether the peer has closed its side or reset, whatever it has sent before that and was not read.
  bool is_peer_gone();
  asio::io_context::executor_type executor() { return socket_.get_executor(); }

 private:
  std::size_t write_record(std::span<const asio::const_buffer> buffers, asio::error_code& error);
  /// Counts the handshake once: established, or `is_over` before it was.
  void note_handshake(bool is_over);

  Socket socket_;
  Metrics* metrics_;
  std::unique_ptr<TlsSession> tls_;
  TlsWant write_want_ = TlsWant::kWritable;
  bool is_handshake_noted_ = false;
  unsigned reads_in_a_row_ = 0;
};

}  // namespace talus::server
