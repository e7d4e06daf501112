// A server whose every byte is the test's, on loopback.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>

#include "client_sample/library/connection.hpp"
#include "core/world/manifest.hpp"
#include "protocol/manifest_toml.hpp"
#include "protocol/message.hpp"
#include "protocol/websocket_accept.hpp"

namespace talus::client {

using asio::ip::tcp;
using Bytes = std::vector<std::byte>;

/// Takes one connection at a time, shakes hands and keeps what the client says; says what it is told to.
class ScriptedServer {
 public:
  explicit ScriptedServer(Loop& loop)
      : acceptor_(loop.context(), tcp::endpoint(asio::ip::address_v4::loopback(), 0)), socket_(loop.context()) {
    accept();
  }

  /// Forgets the connection before, if any.
  void accept() {
    socket_.close();
    received_.clear();
    heard_.clear();
    is_open_ = has_closed_frame_ = false;
    acceptor_.async_accept(socket_, [this](const asio::error_code& error) {
      if (!error) read();
    });
  }

  ServerAddress address() const { return {"127.0.0.1", acceptor_.local_endpoint().port(), ""}; }
  const std::vector<protocol::Message>& heard() const { return heard_; }
  bool has_closed_frame() const { return has_closed_frame_; }

  template <typename T>
  std::size_t heard_of() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(heard_, [](const auto& m) { return std::holds_alternative<T>(m); }));
  }

  void say(const protocol::Message& message, const Bytes& payload = {}) {
    Bytes bytes = protocol::encode(message);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    say_frame(0x82, bytes);
  }
  void say_frame(int first, const Bytes& payload) {
    Bytes frame{static_cast<std::byte>(first)};
    if (payload.size() < 126) {
      frame.push_back(static_cast<std::byte>(payload.size()));
    } else {
      frame.push_back(std::byte{127});
      for (int shift = 56; shift >= 0; shift -= 8) frame.push_back(static_cast<std::byte>(payload.size() >> shift));
    }
    frame.insert(frame.end(), payload.begin(), payload.end());
    write(frame);
  }
  void hang_up() { socket_.close(); }
  void answers_handshake_with(std::string answer) { answer_ = std::move(answer); }

 private:
  void read() {
    socket_.async_read_some(asio::buffer(input_), [this](const asio::error_code& error, std::size_t size) {
      if (error) return;
      received_.append(input_.data(), size);
      if (!is_open_) shake_hands();
      if (is_open_) take_frames();
      read();
    });
  }

  void shake_hands() {
    const std::size_t end = received_.find("\r\n\r\n");
    if (end == std::string::npos) return;
    const std::string field = "Sec-WebSocket-Key: ";
    const std::size_t key = received_.find(field) + field.size();
    const std::string accept = protocol::websocket_accept(received_.substr(key, received_.find("\r\n", key) - key));
    const std::string text = answer_
                                 ? *answer_
                                 : "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                                   "Sec-WebSocket-Accept: " +
                                       accept + "\r\n\r\n";
    const auto bytes = std::as_bytes(std::span(text));
    write({bytes.begin(), bytes.end()});
    received_.erase(0, end + 4);
    is_open_ = true;
  }

  void take_frames() {
    for (;;) {
      if (received_.size() < 2) return;
      std::size_t length = static_cast<unsigned char>(received_[1]) & 0x7FU;
      std::size_t head = 2;
      if (length == 126) {
        if (received_.size() < 4) return;
        length = static_cast<std::size_t>(static_cast<unsigned char>(received_[2])) << 8 |
                 static_cast<unsigned char>(received_[3]);
        head = 4;
      }
      if (received_.size() < head + 4 + length) return;
      Bytes payload(length);
      for (std::size_t i = 0; i < length; ++i) {
        payload[i] = static_cast<std::byte>(received_[head + 4 + i] ^ received_[head + i % 4]);
      }
      const int opcode = received_[0] & 0x0F;
      received_.erase(0, head + 4 + length);
      if (opcode == 8) has_closed_frame_ = true;
      if (opcode != 2) continue;
      const auto decoded = protocol::decode(payload);
      ASSERT_TRUE(decoded);
      heard_.push_back(decoded->message);
    }
  }

  void write(const Bytes& bytes) {
    asio::error_code error;
    asio::write(socket_, asio::buffer(bytes), error);
  }

  tcp::acceptor acceptor_;
  tcp::socket socket_;
  std::array<char, 4096> input_{};
  std::string received_;
  std::optional<std::string> answer_;
  bool is_open_ = false;
  bool has_closed_frame_ = false;
  std::vector<protocol::Message> heard_;
};

/// Runs until `done`, at most thirty seconds.
template <typename Done>
bool run_until(Loop& loop, Done done) {
  for (int i = 0; i < 6000 && !done(); ++i) loop.run_for(std::chrono::milliseconds(5));
  return done();
}

inline protocol::Welcome welcome(const Manifest& manifest = {}, std::uint16_t version = 1) {
  return {version, "s", protocol::world_hash(manifest), "drc", protocol::manifest_json(manifest)};
}

}  // namespace talus::client
