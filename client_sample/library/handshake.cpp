#include "client_sample/library/handshake.hpp"

#include <algorithm>
#include <cctype>

#include "protocol/websocket_accept.hpp"

namespace talus::client {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Value of the first field called `name` (in lower case) in a head without its first line; empty if there is none.
std::string_view field(std::string_view fields, std::string_view name) {
  while (!fields.empty()) {
    const std::size_t end = std::min(fields.find("\r\n"), fields.size());
    const std::string_view line = fields.substr(0, end);
    const std::size_t colon = line.find(':');
    if (colon != std::string_view::npos && lower(line.substr(0, colon)) == name) return trimmed(line.substr(colon + 1));
    fields.remove_prefix(std::min(end + 2, fields.size()));
  }
  return {};
}

}  // namespace

std::string handshake_key(std::uint64_t random_low, std::uint64_t random_high) {
  std::string bytes;
  for (int i = 0; i < 8; ++i) bytes += static_cast<char>(random_low >> (8 * i) & 0xFF);
  for (int i = 0; i < 8; ++i) bytes += static_cast<char>(random_high >> (8 * i) & 0xFF);
  return protocol::base64(bytes);
}

std::string handshake_request(const ServerAddress& server, std::string_view target, std::string_view key) {
  return "GET " + server.prefix + std::string(target) + " HTTP/1.1\r\nHost: " + server.authority() +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: " +
         std::string(key) + "\r\n\r\n";
}

std::optional<ClientError> handshake_fault(std::string_view answer, std::string_view key) {
  const std::string_view head = answer.substr(0, answer.find("\r\n\r\n"));
  const std::size_t line_end = std::min(head.find("\r\n"), head.size());
  const std::string_view status = head.substr(0, line_end);
  if (!status.starts_with("HTTP/1.1 ")) return ClientError{ErrorCode::kHandshake, "the answer is not HTTP/1.1"};
  if (!status.starts_with("HTTP/1.1 101")) {
    const std::size_t body = std::min(head.size() + 4, answer.size());
    // What a 4xx refuses it refuses again; but 429, and what a proxy says of a server that restarts, pass.
    const bool may_pass = !status.starts_with("HTTP/1.1 4") || status.starts_with("HTTP/1.1 429");
    return ClientError{
        ErrorCode::kHandshake,
        "the server answered " + std::string(status.substr(9)) + " " + std::string(answer.substr(body, 300)), may_pass};
  }
  const std::string_view fields = head.substr(std::min(line_end + 2, head.size()));
  if (lower(field(fields, "upgrade")) != "websocket" ||
      lower(field(fields, "connection")).find("upgrade") == std::string::npos) {
    return ClientError{ErrorCode::kHandshake, "the server did not upgrade the connection"};
  }
  if (field(fields, "sec-websocket-accept") != protocol::websocket_accept(key)) {
    return ClientError{ErrorCode::kHandshake, "the server did not understand the key; is there a cache in between?"};
  }
  if (!field(fields, "sec-websocket-extensions").empty()) {
    return ClientError{ErrorCode::kHandshake, "the server uses an extension that was not asked for"};
  }
  return std::nullopt;
}

}  // namespace talus::client
