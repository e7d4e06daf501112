#include "client_sample/library/http_get.hpp"

#include <array>
#include <cctype>
#include <optional>

#include <http_parser.h>
#include <asio/connect.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>

namespace talus::client {
namespace {

using asio::ip::tcp;

constexpr std::size_t kFieldBytesMax = 64 * 1024;

/// What http_parser has found so far.
struct Reading {
  HttpAnswer answer;
  std::string name;
  std::string value;
  bool in_value = false;
  std::size_t field_bytes = 0;
  bool is_whole = false;
  bool is_too_large = false;

  void end_field() {
    if (!name.empty()) answer.fields[name] = value;
    name.clear();
    value.clear();
    in_value = false;
  }
  int take_field(std::string& into, const char* at, std::size_t size) {
    field_bytes += size;
    is_too_large = is_too_large || field_bytes > kFieldBytesMax;
    into.append(at, size);
    return is_too_large ? 1 : 0;
  }
};

Reading& reading_of(http_parser* parser) {
  return *static_cast<Reading*>(parser->data);
}

int on_name(http_parser* parser, const char* at, std::size_t size) {
  Reading& reading = reading_of(parser);
  if (reading.in_value) reading.end_field();
  std::string lower;
  for (const char c : std::string_view(at, size))
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return reading.take_field(reading.name, lower.data(), lower.size());
}

int on_value(http_parser* parser, const char* at, std::size_t size) {
  Reading& reading = reading_of(parser);
  reading.in_value = true;
  return reading.take_field(reading.value, at, size);
}

int on_head_end(http_parser* parser) {
  Reading& reading = reading_of(parser);
  reading.end_field();
  reading.answer.status = parser->status_code;
  return 0;
}

int on_body(http_parser* parser, const char* at, std::size_t size) {
  Reading& reading = reading_of(parser);
  reading.is_too_large = size > kHttpBodyBytesMax - reading.answer.body.size();
  if (reading.is_too_large) return 1;
  reading.answer.body.append(at, size);
  return 0;
}

int on_end(http_parser* parser) {
  reading_of(parser).is_whole = true;
  return 0;
}

http_parser_settings callbacks() {
  http_parser_settings out;
  http_parser_settings_init(&out);
  out.on_header_field = on_name;
  out.on_header_value = on_value;
  out.on_headers_complete = on_head_end;
  out.on_body = on_body;
  out.on_message_complete = on_end;
  return out;
}

/// One request with a deadline: every wait is an asynchronous operation that the deadline can end.
class Exchange {
 public:
  Exchange(const ServerAddress& server, std::chrono::milliseconds timeout)
      : server_(server), until_(std::chrono::steady_clock::now() + timeout), socket_(context_) {}

  std::expected<HttpAnswer, ClientError> get(std::string_view target) {
    if (auto error = connect()) return std::unexpected(*error);
    const std::string request = "GET " + server_.prefix + std::string(target) +
                                " HTTP/1.1\r\nHost: " + server_.authority() +
                                "\r\nUser-Agent: talus\r\nAccept: */*\r\nConnection: close\r\n\r\n";
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
    asio::async_connect(socket_, found, [&](const asio::error_code& e, const tcp::endpoint&) { error = e; });
    if (!wait(error)) return failed(error);
    return std::nullopt;
  }

  std::expected<HttpAnswer, ClientError> read() {
    Reading reading;
    http_parser parser;
    http_parser_init(&parser, HTTP_RESPONSE);
    parser.data = &reading;
    const http_parser_settings settings = callbacks();
    std::array<char, 64 * 1024> input{};
    while (!reading.is_whole) {
      asio::error_code error = asio::error::would_block;
      std::size_t size = 0;
      socket_.async_read_some(asio::buffer(input), [&](const asio::error_code& e, std::size_t n) {
        error = e;
        size = n;
      });
      const bool is_read = wait(error);
      if (!is_read && error != asio::error::eof) return std::unexpected(failed(error));
      // Zero bytes tell the parser that the connection has ended, which ends bodies without a length.
      const std::size_t used = http_parser_execute(&parser, &settings, input.data(), is_read ? size : 0);
      if (reading.is_whole) break;
      if (reading.is_too_large) return std::unexpected(ClientError{ErrorCode::kHttp, "the answer is too large"});
      if (!is_read || used != size || HTTP_PARSER_ERRNO(&parser) != HPE_OK) {
        return std::unexpected(ClientError{ErrorCode::kHttp, server_.authority() + " does not answer in HTTP"});
      }
    }
    return std::move(reading.answer);
  }

  /// Runs until the one operation under way has set `error`, or the deadline has come.
  bool wait(const asio::error_code& error) {
    context_.restart();
    while (error == asio::error::would_block && context_.run_one_until(until_) > 0) {
    }
    if (error != asio::error::would_block) return !error;
    asio::error_code ignored;
    socket_.close(ignored);
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
  tcp::socket socket_;
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
