// The stream against a scripted server on loopback: every byte of the server is the test's.
#include "client_sample/library/world_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "protocol/limits.hpp"
#include "tests/unit/library/scripted_server.hpp"

namespace talus::client {
namespace {

using testing::HasSubstr;

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
