// The stream against a scripted server on loopback: every byte of the server is the test's.
#include "client_sample/library/world_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>

#include "core/world/manifest.hpp"
#include "protocol/limits.hpp"
#include "protocol/manifest_toml.hpp"
#include "protocol/websocket_accept.hpp"

namespace talus::client {
namespace {

using asio::ip::tcp;
using Bytes = std::vector<std::byte>;
using testing::HasSubstr;

/// Takes one connection, shakes hands and keeps what the client says; says what it is told to.
class ScriptedServer {
 public:
  explicit ScriptedServer(Loop& loop)
      : acceptor_(loop.context(), tcp::endpoint(asio::ip::address_v4::loopback(), 0)), socket_(loop.context()) {
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

/// Runs until `done`, at most two seconds.
template <typename Done>
bool run_until(Loop& loop, Done done) {
  for (int i = 0; i < 400 && !done(); ++i) loop.run_for(std::chrono::milliseconds(5));
  return done();
}

protocol::Welcome welcome() {
  return {1, "s", protocol::world_hash(Manifest{}), "drc", protocol::manifest_json(Manifest{})};
}

class WorldStreamTest : public testing::Test {
 protected:
  void open(StreamOptions options = {}) {
    options.server = server.address();
    StreamHandlers handlers;
    handlers.on_chunk = [this](const ArrivedChunk& chunk) {
      chunks.push_back(chunk.head.key);
      payload_bytes += chunk.payload.size();
      message_bytes += chunk.message_bytes;
    };
    handlers.on_leave = [this](const std::vector<ChunkKey>& keys) { left = keys; };
    handlers.on_idle = [this](const protocol::Idle& message) { idle = message; };
    handlers.on_closed = [this](const ClientError& error) { closed.push_back(error); };
    stream.emplace(loop, std::move(options), std::move(handlers));
  }
  bool hello_came() {
    return run_until(loop, [this] { return server.heard_of<protocol::Hello>() == 1; });
  }

  Loop loop;
  ScriptedServer server{loop};
  std::optional<WorldStream> stream;
  std::vector<ChunkKey> chunks;
  std::size_t payload_bytes = 0;
  std::size_t message_bytes = 0;
  std::vector<ChunkKey> left;
  std::optional<protocol::Idle> idle;
  std::vector<ClientError> closed;
};

TEST_F(WorldStreamTest, GreetsThenSaysWhatItHoldsThenWhatItSees) {
  StreamOptions options;
  options.held.resize(protocol::kKeysPerMessageMax + 1);
  open(options);
  protocol::View view;
  view.position = {1, 2, 3};
  stream->look({});
  EXPECT_EQ(stream->look(view), 2U);
  ASSERT_TRUE(hello_came());
  EXPECT_EQ(server.heard().size(), 1U) << "nothing but hello before the welcome";
  server.say(welcome());
  ASSERT_TRUE(run_until(loop, [&] { return server.heard_of<protocol::ViewMessage>() == 1; }));
  EXPECT_EQ(server.heard_of<protocol::Held>(), 2U);
  const auto& sent = std::get<protocol::ViewMessage>(server.heard().back());
  EXPECT_EQ(sent.sequence, 2U) << "the latest view wins";
  EXPECT_EQ(sent.view.position, view.position);
  EXPECT_EQ(stream->info()->name, "default");
}

TEST_F(WorldStreamTest, HandsOverChunksAndGivesTheirBytesBack) {
  StreamOptions options;
  options.credit_bytes = 8000;
  open(options);
  ASSERT_TRUE(hello_came());
  server.say(welcome());
  const Bytes payload(5000);
  server.say(protocol::ChunkHead{{0, 1, 2, 3}, 0, ChunkKind::kMesh, 5000}, payload);
  server.say(protocol::Leave{{{0, 9, 9, 9}}});
  server.say(protocol::Idle{4, 1});
  ASSERT_TRUE(run_until(loop, [&] { return idle.has_value() && server.heard_of<protocol::Credit>() == 1; }));
  EXPECT_EQ(chunks, (std::vector<ChunkKey>{{0, 1, 2, 3}}));
  EXPECT_EQ(payload_bytes, 5000U);
  EXPECT_EQ(left, (std::vector<ChunkKey>{{0, 9, 9, 9}}));
  const auto head = protocol::encode(protocol::ChunkHead{{0, 1, 2, 3}, 0, ChunkKind::kMesh, 5000});
  EXPECT_EQ(std::get<protocol::Credit>(server.heard().back()).bytes, head.size() + 5000);
  EXPECT_EQ(message_bytes, head.size() + 5000);
}

TEST_F(WorldStreamTest, AnswersPings) {
  open();
  ASSERT_TRUE(hello_came());
  server.say(protocol::Ping{77});
  server.say_frame(0x89, {std::byte{1}});
  ASSERT_TRUE(run_until(loop, [&] { return server.heard_of<protocol::Pong>() == 1; }));
  EXPECT_EQ(std::get<protocol::Pong>(server.heard().back()).nonce, 77U);
}

TEST_F(WorldStreamTest, SaysWhyItWasRefused) {
  open();
  ASSERT_TRUE(hello_came());
  server.say(protocol::Refused{protocol::RefusedReason::kWorld, "no such world", {1}});
  ASSERT_TRUE(run_until(loop, [&] { return server.has_closed_frame(); }));
  server.hang_up();
  ASSERT_TRUE(run_until(loop, [&] { return !closed.empty(); }));
  EXPECT_EQ(closed[0].code, ErrorCode::kRefused);
  EXPECT_THAT(closed[0].message, HasSubstr("no such world"));
}

TEST_F(WorldStreamTest, SaysOnceThatTheConnectionBroke) {
  open();
  ASSERT_TRUE(hello_came());
  server.hang_up();
  ASSERT_TRUE(run_until(loop, [&] { return !closed.empty(); }));
  loop.run_for(std::chrono::milliseconds(20));
  ASSERT_EQ(closed.size(), 1U);
  EXPECT_EQ(closed[0].code, ErrorCode::kConnect);
  stream->look({});
}

TEST_F(WorldStreamTest, ClosesOnBytesThatBreakTheProtocol) {
  open();
  ASSERT_TRUE(hello_came());
  server.say_frame(0x82, Bytes(9, std::byte{0xFF}));
  ASSERT_TRUE(run_until(loop, [&] { return server.has_closed_frame(); }));
  server.hang_up();
  ASSERT_TRUE(run_until(loop, [&] { return !closed.empty(); }));
  EXPECT_EQ(closed[0].code, ErrorCode::kProtocol);
}

TEST_F(WorldStreamTest, RefusesChunksBeforeTheWelcome) {
  open();
  ASSERT_TRUE(hello_came());
  server.say(protocol::ChunkHead{{0, 0, 0, 0}, 0, ChunkKind::kAir, 0});
  ASSERT_TRUE(run_until(loop, [&] { return server.has_closed_frame(); }));
  EXPECT_TRUE(chunks.empty());
}

TEST_F(WorldStreamTest, SaysWhatTheServerAnsweredInsteadOfAHandshake) {
  server.answers_handshake_with("HTTP/1.1 503 Service Unavailable\r\n\r\n{\"error\":\"busy\"}");
  open();
  ASSERT_TRUE(run_until(loop, [&] { return !closed.empty(); }));
  EXPECT_EQ(closed[0].code, ErrorCode::kHandshake);
  EXPECT_THAT(closed[0].message, HasSubstr("503"));
}

TEST_F(WorldStreamTest, SaysThatNobodyListens) {
  ServerAddress nobody;
  {
    asio::io_context context;
    const tcp::acceptor free(context, tcp::endpoint(asio::ip::address_v4::loopback(), 0));
    nobody.port = free.local_endpoint().port();
  }
  std::optional<ClientError> why;
  Connection connection(loop, nobody, "/", {nullptr, nullptr, [&](const ClientError& error) { why = error; }});
  ASSERT_TRUE(run_until(loop, [&] { return why.has_value(); }));
  EXPECT_EQ(why->code, ErrorCode::kConnect);
}

TEST_F(WorldStreamTest, IsSilentOnceDropped) {
  open();
  ASSERT_TRUE(hello_came());
  stream.reset();
  server.say(welcome());
  loop.run_for(std::chrono::milliseconds(30));
  EXPECT_TRUE(closed.empty());
}

}  // namespace
}  // namespace talus::client
