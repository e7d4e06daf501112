// Bytes to and from one peer, in clear or through TLS; connections do not know which.
//
// The shape is that of a non-blocking socket: reads and writes are tried at once, and waited for only when the kernel
// has nothing or is full. Owner: one connection, on its thread. Everything that is awaited ends with an error once the
// channel is closed.
#pragma once

#include <memory>
#include <span>

#include "server/net/poller.hpp"
#include "server/net/socket.hpp"
#include "server/net/tls.hpp"
#include "server/observe/metrics.hpp"

namespace talus::server {

class Channel final : private Polled {
 public:
  /// Of a connected, non-blocking socket; in clear when `tls` is nullptr. The others must outlive the channel. On the
  /// thread of `poller`.
  Channel(Poller& poller, Descriptor socket, const TlsContext* tls, Metrics& metrics);
  ~Channel();

  struct Read {
    asio::error_code error;
    std::size_t bytes = 0;
  };
  /// Some bytes, or why there are none: `would_block`, or the end. A TLS handshake is part of the first read.
  Read read_now(std::span<std::byte> into);
  /// The same, waiting while it would block.
  Awaitable<Read> read_some(std::span<std::byte> into);
  /// Whoever reads without a coroutine is told when it is worth trying; not while one waits in `read_some`.
  class Reader {
   public:
    virtual void readable() noexcept = 0;

   protected:
    ~Reader() = default;
  };
  void tell(Reader* reader) { reader_ = reader; }
  /// As much as is taken at once; `would_block` when nothing is. What follows the returned bytes must come first in the
  /// next call.
  std::size_t write_some(std::span<const asio::const_buffer> buffers, asio::error_code& error);
  /// After `would_block`: until a write is worth trying.
  Awaitable<asio::error_code> wait_writable();

  /// Nothing more will be written; reading goes on.
  void shutdown_send();
  /// The same, and what still comes is read and dropped: to the peer's end, or so many bytes.
  Awaitable<void> hear_out(std::size_t bytes_max);
  void close();
  /// Ends the connection at once; what was not taken is lost (SO_LINGER 0).
  void reset();
  /// Whether the peer has closed its side or reset, whatever it has sent before that and was not read.
  bool is_peer_gone();
  asio::io_context::executor_type executor() { return poller_.executor(); }

 private:
  void ready(std::uint32_t events) noexcept override;
  Read receive(std::span<std::byte> into);
  Read receive_record(std::span<std::byte> into);
  std::size_t write_clear(std::span<const asio::const_buffer> buffers, asio::error_code& error);
  std::size_t write_record(std::span<const asio::const_buffer> buffers, asio::error_code& error);
  /// Counts the handshake once: established, or `is_over` before it was.
  void note_handshake(bool is_over);
  void end();

  Poller& poller_;
  Descriptor socket_;
  Metrics& metrics_;
  Reader* reader_ = nullptr;
  std::unique_ptr<TlsSession> tls_;
  TlsWant read_want_ = TlsWant::kReadable;
  TlsWant write_want_ = TlsWant::kWritable;
  bool is_handshake_noted_ = false;

  bool may_read_ = false;  ///< false: an edge will come
  bool may_write_ = true;
  bool is_short_read_last_ = true;  ///< a read that does not fill its room has taken all there was
  bool is_read_awaited_ = false;
  bool is_write_awaited_ = false;
  unsigned reads_in_a_row_ = 0;
  Bell readable_;
  Bell writable_;
};

}  // namespace talus::server
