// A raw client of a server under test: one socket that blocks for a bounded time, so that a test which waits for what
// never comes fails instead of hanging. The bound is far above what a sanitized build on a loaded machine needs.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

namespace talus::server {

class Peer {
 public:
  /// `address` as a server says it: "127.0.0.1:43210". Comes from 127.0.0.1 + `host`, so that many peers need not share
  /// one address and its ports.
  explicit Peer(std::string_view address, int receive_bytes = 0, std::uint32_t host = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_bytes != 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    if (host != 0) {
      sockaddr_in from{};
      from.sin_family = AF_INET;
      from.sin_addr.s_addr = htonl(INADDR_LOOPBACK + host);
      ::bind(socket_, reinterpret_cast<const sockaddr*>(&from), sizeof from);
    }
    wait_at_most(60);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const std::string port(address.substr(address.rfind(':') + 1));
    to.sin_port = htons(static_cast<std::uint16_t>(std::atoi(port.c_str())));
    is_connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  Peer(Peer&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), is_connected_(other.is_connected_), left_(std::move(other.left_)) {}
  Peer& operator=(Peer&&) = delete;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() { close(); }

  bool is_connected() const { return is_connected_; }
  /// Our own, as the kernel writes it.
  in_port_t port() const {
    sockaddr_in own{};
    socklen_t length = sizeof own;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &length);
    return own.sin_port;
  }
  void close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }
  void close_sending() { ::shutdown(socket_, SHUT_WR); }
  void wait_at_most(int seconds) {
    const timeval limit{seconds, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  }

  bool send(std::string_view text) {
    while (!text.empty()) {
      const ssize_t sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  /// Adds what has come to the bytes kept here. False at the end, on an error and when nothing came in the time.
  bool receive() {
    char buffer[65536];
    const ssize_t got = ::recv(socket_, buffer, sizeof buffer, 0);
    if (got > 0) left_.append(buffer, static_cast<std::size_t>(got));
    is_ended_ = is_ended_ || got == 0;
    return got > 0;
  }
  /// Whether the other side has ended the connection, by FIN or reset, before the time was up.
  bool is_ended_by_other() {
    for (;;) {
      char byte;
      const ssize_t got = ::recv(socket_, &byte, 1, 0);
      if (got > 0) continue;
      return got == 0 || errno == ECONNRESET;
    }
  }
  /// Exactly `size` bytes, or fewer when no more come.
  std::string take(std::size_t size) {
    while (left_.size() < size && receive()) {
    }
    std::string out = left_.substr(0, size);
    left_.erase(0, out.size());
    if (left_.empty()) left_.shrink_to_fit();  // a test may hold thousands of these
    return out;
  }
  std::string take_until(std::string_view mark) {
    std::size_t at = left_.find(mark);
    while (at == std::string::npos && receive()) at = left_.find(mark);
    return take(at == std::string::npos ? left_.size() : at + mark.size());
  }

 private:
  int socket_;
  bool is_connected_ = false;
  bool is_ended_ = false;
  std::string left_;
};

/// An answer as it came.
struct Response {
  int status = 0;
  std::string head;
  std::string body;

  std::string field(std::string_view name) const {
    const std::size_t at = head.find("\r\n" + std::string(name) + ": ");
    if (at == std::string::npos) return {};
    const std::size_t start = at + 4 + name.size();
    return head.substr(start, head.find("\r\n", start) - start);
  }
};

/// Reads one answer; `has_body` is false for answers to HEAD.
inline Response read_response(Peer& peer, bool has_body = true) {
  Response out;
  out.head = peer.take_until("\r\n\r\n");
  if (out.head.size() > 12) out.status = std::atoi(out.head.c_str() + 9);
  const std::string length = out.field("Content-Length");
  if (has_body && !length.empty()) out.body = peer.take(static_cast<std::size_t>(std::atoll(length.c_str())));
  return out;
}

inline std::string get_request(std::string_view target, std::string_view fields = {}) {
  return "GET " + std::string(target) + " HTTP/1.1\r\nHost: a\r\n" + std::string(fields) + "\r\n";
}

inline Response get(std::string_view address, std::string_view target, std::string_view fields = {}) {
  Peer peer(address);
  peer.send(get_request(target, fields));
  return read_response(peer);
}

}  // namespace talus::server
