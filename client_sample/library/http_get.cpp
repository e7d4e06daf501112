#include "client_sample/library/http_get.hpp"

#include <array>
#include <optional>
#include <span>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>

#include "client_sample/library/client_socket.hpp"

namespace talus::client {
namespace {

using asio::ip::tcp;

/// One request with a deadline: every wait is an asynchronous operation that the deadline can end.
class Exchange {
 public:
  Exchange(const ServerAddress& server, std::chrono::milliseconds timeout)
      : server_(server), until_(std::chrono::steady_clock::now() + timeout), socket_(context_, server) {}

  std::expected<HttpAnswer, ClientError> get(std::string_view target) {
    if (auto error = connect()) return std::unexpected(*error);
    const std::string request =
        "GET " + server_.prefix + std::string(target) + " HTTP/1.1\r\nHost: " + server_.authority() +
        "\r\nUser-Agent: talus\r\nAccept: */*\r\n" + server_.authorization() + "Connection: close\r\n\r\n";
    asio::error_code error = asio::error::would_block;
    asio::async_write(socket_, asio::buffer(request), [&](const asio::error_code& e, std::size_t) { error = e; });
    if (!wait(error)) return std::unexpected(failed(error));
    return read();
  }

 private:
  std::optional<ClientError> connect() {
    tcp::resolver resolver(context_);
    asio::error_code error = asio::error::would_block;
    tcp::resolver::results_type found;
    resolver.async_resolve(server_.host, std::to_string(server_.port), [&](const asio::error_code& e, auto results) {
      error = e;
      found = results;
    });
    if (!wait(error)) return ClientError{ErrorCode::kResolve, "no address for " + server_.host};
    error = asio::error::would_block;
    socket_.async_open(found, [&](const asio::error_code& e) { error = e; });
    if (!wait(error)) return failed(error);
    return std::nullopt;
  }

  std::expected<HttpAnswer, ClientError> read() {
    HttpReader reader;
    std::array<char, 64 * 1024> input{};
    for (;;) {
      asio::error_code error = asio::error::would_block;
      std::size_t size = 0;
      socket_.async_read_some(asio::buffer(input), [&](const asio::error_code& e, std::size_t n) {
        error = e;
        size = n;
      });
      const bool is_read = wait(error);
      if (!is_read && error != asio::error::eof) return std::unexpected(failed(error));
      switch (reader.feed(std::span(input).first(is_read ? size : 0))) {
        case HttpReader::State::kWhole:
          return reader.take();
        case HttpReader::State::kTooLarge:
          return std::unexpected(ClientError{ErrorCode::kHttp, "the answer is too large"});
        case HttpReader::State::kMore:
          if (is_read) break;
          [[fallthrough]];
        case HttpReader::State::kBroken:
          return std::unexpected(ClientError{ErrorCode::kHttp, server_.authority() + " does not answer in HTTP"});
      }
    }
  }

  /// Runs until the one operation under way has set `error`, or the deadline has come.
  bool wait(const asio::error_code& error) {
    context_.restart();
    while (error == asio::error::would_block && context_.run_one_until(until_) > 0) {
    }
    if (error != asio::error::would_block) return !error;
    socket_.close();
    context_.stop();
    return false;
  }

  ClientError failed(const asio::error_code& error) const {
    if (error == asio::error::would_block)
      return {ErrorCode::kTimeout, server_.authority() + " does not answer in time"};
    return {ErrorCode::kConnect, "no connection to " + server_.authority() + " (" + error.message() + ")"};
  }

  const ServerAddress& server_;
  std::chrono::steady_clock::time_point until_;
  asio::io_context context_{1};
  ClientSocket socket_;
};

}  // namespace

std::expected<HttpAnswer, ClientError> http_get(const ServerAddress& server, std::string_view target,
                                                std::chrono::milliseconds timeout) {
  if (server.carrier == Carrier::kTcp) {
    return std::unexpected(
        ClientError{ErrorCode::kUrl, server.authority() + " speaks no HTTP: give an http:// address"});
  }
  Exchange exchange(server, timeout);
  return exchange.get(target);
}

}  // namespace talus::client
