// A socket of the library, in clear or through TLS; what uses it reads and writes it as any stream of Asio.
//
// The server's certificate must be signed by an authority of the address's `ca_file`, or of the system when none is
// named, and be made out to the address's host. Owner: one connection.
#pragma once

#include <memory>
#include <utility>

#include <asio/buffer.hpp>
#include <asio/connect.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ssl/stream.hpp>

#include "client_sample/library/server_address.hpp"

namespace talus::client {

class ClientSocket {
 public:
  using executor_type = asio::ip::tcp::socket::executor_type;
  using Secure = asio::ssl::stream<asio::ip::tcp::socket&>;

  /// Nothing is opened yet; `server` says whether TLS is spoken.
  ClientSocket(asio::io_context& context, const ServerAddress& server) : socket_(context), server_(server) {}

  executor_type get_executor() { return socket_.get_executor(); }

  /// Connects to one of the addresses and shakes hands. `done(error)`.
  template <typename Done>
  void async_open(const asio::ip::tcp::resolver::results_type& found, Done done) {
    asio::async_connect(
        socket_, found,
        [this, done = std::move(done)](const asio::error_code& error, const asio::ip::tcp::endpoint&) mutable {
          if (error || !server_.is_secure) return done(error);
          if (const asio::error_code fault = begin_tls()) return done(fault);
          secure_->async_handshake(Secure::client, std::move(done));
        });
  }
  template <typename Buffers, typename Done>
  void async_read_some(const Buffers& buffers, Done&& done) {
    secure_ ? secure_->async_read_some(buffers, std::forward<Done>(done))
            : socket_.async_read_some(buffers, std::forward<Done>(done));
  }
  template <typename Buffers, typename Done>
  void async_write_some(const Buffers& buffers, Done&& done) {
    secure_ ? secure_->async_write_some(buffers, std::forward<Done>(done))
            : socket_.async_write_some(buffers, std::forward<Done>(done));
  }

  /// Until the other side has cut the connection, without reading what it sent. `done(error)`.
  template <typename Done>
  void async_wait_cut(Done&& done) {
    socket_.async_wait(asio::ip::tcp::socket::wait_error, std::forward<Done>(done));
  }

  void set_no_delay();
  /// Nothing more will be sent; reading goes on. TLS has no such half: there nothing happens.
  void end_sending();
  /// Everything under way ends with an error. A closed socket may be opened again.
  void close();

 private:
  asio::error_code begin_tls();

  asio::ip::tcp::socket socket_;
  const ServerAddress& server_;
  std::unique_ptr<Secure> secure_;
};

}  // namespace talus::client
