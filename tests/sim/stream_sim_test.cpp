// A whole server, streamed from over raw sockets.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/meshopt_codec.hpp"
#include "tests/sim/running_server.hpp"
#include "tests/sim/stream_peer.hpp"

namespace talus::server {
namespace {

using Carrier = StreamPeer::Carrier;
using protocol::Bye;
using protocol::ByeReason;
using protocol::ChunkHead;

/// What came until idle: the keys of chunks, sorted.
struct View {
  std::vector<ChunkKey> keys;
  std::uint64_t bytes = 0;
  std::uint32_t accepted_chunks = 0;
  bool is_complete = false;
};
View read_view(StreamPeer& stream) {
  View out;
  while (auto message = stream.next()) {
    if (const auto* chunk = std::get_if<ChunkHead>(&*message)) {
      out.keys.push_back(chunk->key);
      out.bytes += stream.message_bytes;
    } else if (const auto* accepted = std::get_if<protocol::ViewAccepted>(&*message)) {
      out.accepted_chunks = accepted->chunks;
    } else if (std::holds_alternative<protocol::Idle>(*message)) {
      out.is_complete = true;
      break;
    }
  }
  std::sort(out.keys.begin(), out.keys.end());
  return out;
}

class StreamSim : public testing::TestWithParam<Carrier> {
 protected:
  StreamPeer connect(RunningServer& server) {
    return {GetParam() == Carrier::kTcp ? server->tcp_address() : server->http_address(), GetParam()};
  }
};
INSTANTIATE_TEST_SUITE_P(Carriers, StreamSim, testing::Values(Carrier::kWebSocket, Carrier::kTcp));

TEST_P(StreamSim, SendsAWholeViewThenIdleThenOnlyWhatChanges) {
  RunningServer server;
  StreamPeer stream = connect(server);
  ASSERT_TRUE(stream.open(kPlenty));
  stream.look_from(0, 700);
  const View first = read_view(stream);
  ASSERT_TRUE(first.is_complete);
  EXPECT_EQ(first.keys.size(), first.accepted_chunks);
  EXPECT_EQ(std::adjacent_find(first.keys.begin(), first.keys.end()), first.keys.end());

  stream.look_from(64, 700, 2);
  const View second = read_view(stream);
  ASSERT_TRUE(second.is_complete);
  EXPECT_GT(second.keys.size(), 0U);
  EXPECT_LT(second.keys.size(), first.keys.size() / 2);
  stream.send(protocol::Bye{ByeReason::kLeaving, ""});
  EXPECT_TRUE(stream.peer.is_ended_by_other());
}

TEST_P(StreamSim, StopsWhenCreditIsUsedUpAndResumesWithMore) {
  RunningServer server;
  StreamPeer stream = connect(server);
  constexpr std::uint64_t kCredit = 60'000;
  ASSERT_TRUE(stream.open(kCredit));
  stream.look_from(0, 700);
  ASSERT_TRUE(eventually([&] { return server.count(Count::kCreditWaits) == 1; }));
  stream.send(protocol::Ping{77});
  std::uint64_t bytes = 0;
  bool is_answered = false;
  while (!is_answered) {
    const auto message = stream.next();
    ASSERT_TRUE(message.has_value()) << "control messages need no credit";
    ASSERT_FALSE(std::holds_alternative<protocol::Idle>(*message));
    bytes += std::holds_alternative<ChunkHead>(*message) ? stream.message_bytes : 0;
    const auto* pong = std::get_if<protocol::Pong>(&*message);
    is_answered = pong != nullptr;
    EXPECT_TRUE(!is_answered || pong->nonce == 77U);
  }
  EXPECT_LE(bytes, kCredit);
  stream.send(protocol::Credit{kPlenty});
  EXPECT_TRUE(read_view(stream).is_complete);
}

TEST_P(StreamSim, DoesNotSendAgainWhatIsHeldAfterAReconnect) {
  RunningServer server;
  StreamPeer first = connect(server);
  ASSERT_TRUE(first.open(kPlenty));
  first.look_from(0, 500);
  const View all = read_view(first);
  first.peer.close();

  StreamPeer second = connect(server);
  ASSERT_TRUE(second.open(kPlenty));
  protocol::Held held;
  for (std::size_t i = 0; i + 3 < all.keys.size(); ++i) held.chunks.push_back({all.keys[i], 0});
  second.send(held);
  second.look_from(0, 500);
  const View rest = read_view(second);
  EXPECT_TRUE(rest.is_complete);
  EXPECT_EQ(rest.keys, std::vector<ChunkKey>(all.keys.end() - 3, all.keys.end()));
}

TEST_P(StreamSim, SendsWhatIsWantedByKey) {
  RunningServer server;
  StreamPeer stream = connect(server);
  ASSERT_TRUE(stream.open(kPlenty));
  protocol::Want want;
  for (std::int32_t x = 0; x < 5; ++x) want.chunks.push_back({{6, x, 0, 0}, 0});
  stream.send(want);
  EXPECT_EQ(read_view(stream).keys.size(), 5U);
}

TEST_P(StreamSim, RefusesHellosItCannotServeWithAReason) {
  RunningServer server;
  protocol::Hello good;
  good.version_low = good.version_high = 1;
  good.world = "default";
  const auto reason_of = [&](const protocol::Hello& hello) {
    StreamPeer stream = connect(server);
    stream.send(hello);
    const auto refused = stream.next_of<protocol::Refused>();
    EXPECT_TRUE(stream.peer.is_ended_by_other());
    EXPECT_EQ(refused->versions, (std::vector<std::uint16_t>{1, 2, 3}));
    return refused->reason;
  };
  protocol::Hello hello = good;
  hello.version_low = hello.version_high = 9;
  EXPECT_EQ(reason_of(hello), protocol::RefusedReason::kVersion);
  hello = good;
  hello.world = "atlantis";
  EXPECT_EQ(reason_of(hello), protocol::RefusedReason::kWorld);
  hello = good;
  hello.formats = {"obj"};
  EXPECT_EQ(reason_of(hello), protocol::RefusedReason::kFormat);
}

TEST_P(StreamSim, SendsTheFirstFormatOfThePeersThatItHas) {
  RunningServer server;
  StreamPeer stream = connect(server);
  protocol::Hello hello;
  hello.version_low = hello.version_high = 2;
  hello.world = "default";
  hello.formats = {"obj", "mesh", "drc"};
  hello.credit_bytes = kPlenty;
  stream.send(hello);
  const auto welcome = stream.next_of<protocol::Welcome>();
  ASSERT_TRUE(welcome.has_value());
  EXPECT_EQ(welcome->format, "mesh");
  stream.look_from(0, 500);
  int chunks = 0;
  int strips = 0;
  while (const auto message = stream.next()) {
    if (std::holds_alternative<protocol::Idle>(*message)) break;
    if (stream.payload.empty()) continue;
    if (const auto* chunk = std::get_if<ChunkHead>(&*message)) {
      ++chunks;
      EXPECT_TRUE(protocol::decode_meshopt(stream.payload, protocol::mesh_lattice(chunk->key, 32, 1.0)));
    } else if (const auto* strip = std::get_if<protocol::StripHead>(&*message)) {
      ++strips;
      EXPECT_TRUE(protocol::decode_meshopt(stream.payload, protocol::strip_lattice(strip->strip.key, 32, 1.0)));
    }
  }
  EXPECT_GT(chunks, 0);
  EXPECT_GT(strips, 0);
}

TEST_P(StreamSim, EndsAPeerThatSendsNonsenseAndNamesTheReason) {
  RunningServer server;
  const std::vector<std::string> kNonsense{"", "x", std::string(100, '\xff'), std::string("\x04\0\0\0\0\0\0\0", 8)};
  for (const std::string& bytes : kNonsense) {
    StreamPeer stream = connect(server);
    ASSERT_TRUE(stream.open(kPlenty));
    stream.send_bytes(bytes);
    const auto bye = stream.next_of<Bye>();
    ASSERT_TRUE(bye.has_value());
    EXPECT_EQ(bye->reason, ByeReason::kMalformed);
    EXPECT_TRUE(stream.peer.is_ended_by_other());
  }
  EXPECT_EQ(server.count(Count::kByeMalformed), kNonsense.size());
}

TEST_P(StreamSim, EndsAPeerThatTalksOutOfTurn) {
  RunningServer server;
  StreamPeer early = connect(server);
  early.look_from(0, 500);
  EXPECT_EQ(early.next_of<Bye>()->reason, ByeReason::kMalformed);
  StreamPeer twice = connect(server);
  ASSERT_TRUE(twice.open(kPlenty));
  protocol::Hello hello;
  hello.version_low = hello.version_high = 1;
  hello.world = "default";
  twice.send(hello);
  EXPECT_EQ(twice.next_of<Bye>()->reason, ByeReason::kMalformed);
}

TEST_P(StreamSim, EndsAPeerThatFloods) {
  RunningServer server;
  StreamPeer stream = connect(server);
  ASSERT_TRUE(stream.open(0));
  for (int i = 0; i < 400; ++i) stream.send(protocol::Credit{0});
  EXPECT_EQ(stream.next_of<Bye>()->reason, ByeReason::kTooManyMessages);
  EXPECT_EQ(server.count(Count::kByeTooManyMessages), 1U);
}

TEST_P(StreamSim, EndsAStreamThatNeverSaysHello) {
  Settings settings = quiet_settings();
  settings.limits.silent_s = 0.2;
  RunningServer server(settings);
  StreamPeer stream = connect(server);
  EXPECT_EQ(stream.next_of<Bye>()->reason, ByeReason::kSilent);
  EXPECT_TRUE(stream.peer.is_ended_by_other());
}

TEST_P(StreamSim, PingsASilentStreamAndEndsItWhenNothingComes) {
  Settings settings = quiet_settings();
  settings.limits.ping_s = 0.2;
  settings.limits.gone_s = 0.8;
  RunningServer server(settings);
  StreamPeer stream = connect(server);
  ASSERT_TRUE(stream.open(0));
  const auto frame = stream.next_frame();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->opcode, GetParam() == Carrier::kTcp ? 2 : 9);
  EXPECT_TRUE(stream.peer.is_ended_by_other());
  EXPECT_EQ(server.count(Count::kByeSilent), 1U);
}

TEST_P(StreamSim, ResetsAReaderThatTakesNothingAndHoldsLittleForIt) {
  Settings settings = quiet_settings();
  settings.limits.write_stall_s = 0.5;
  RunningServer server(settings);
  StreamPeer stream(GetParam() == Carrier::kTcp ? server->tcp_address() : server->http_address(), GetParam(), 4096);
  ASSERT_TRUE(stream.open(kPlenty));
  stream.look_from(0, 6000);
  EXPECT_TRUE(eventually([&] { return server.count(Count::kWriteStalled) == 1; }));
  EXPECT_LT(server.count(Count::kChunkBytesSent), 3'000'000U) << "kernel buffers and the send queue, no more";
}

TEST_P(StreamSim, TakesBackTheWorkOfAViewerThatLeaves) {
  Settings settings = quiet_settings();
  settings.threads = 1;
  RunningServer server(settings);
  StreamPeer stream = connect(server);
  ASSERT_TRUE(stream.open(kPlenty));
  stream.look_from(50'000, 8000);
  ASSERT_TRUE(stream.next_of<ChunkHead>().has_value());
  stream.peer.close();
  EXPECT_TRUE(eventually([&] { return server.count(Count::kChunkCancelled) > 0; }));
  EXPECT_TRUE(eventually(
      [&] { return get(server->admin_address(), "/metrics").body.find("talus_flights 0\n") != std::string::npos; }));
}

TEST_P(StreamSim, SaysDrainingAndEndsWellWhenTheServerStops) {
  RunningServer server;
  StreamPeer stream = connect(server);
  ASSERT_TRUE(stream.open(kPlenty));
  std::thread stopping([&] { server->stop(); });
  EXPECT_EQ(stream.next_of<Bye>()->reason, ByeReason::kDraining);
  if (GetParam() == Carrier::kWebSocket) {
    const auto close = stream.next_frame();
    ASSERT_TRUE(close.has_value());
    EXPECT_EQ(close->opcode, 8);
    EXPECT_EQ(close->bytes.substr(0, 2), "\x03\xe9");
  }
  EXPECT_TRUE(stream.peer.is_ended_by_other());
  stream.peer.close();
  stopping.join();
  EXPECT_FALSE(Peer(server->http_address()).is_connected());
}

TEST(WebSocketSim, SpeaksItsHandshakeAndEndsOnFramesNoClientMaySend) {
  RunningServer server;
  struct Case {
    std::string wire;
    std::string code;
  };
  const std::vector<Case> kTable{{std::string("\x82\x01x", 3), "\x03\xea"},
                                 {std::string("\x81\x81\0\0\0\0x", 7), "\x03\xeb"},
                                 {std::string("\x82\xff\0\0\0\0\0\x01\0\x01\0\0\0\0x", 15), "\x03\xf1"}};
  for (const Case& c : kTable) {
    StreamPeer stream(server->http_address());
    EXPECT_NE(stream.handshake.find("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"), std::string::npos);
    stream.peer.send(c.wire);
    EXPECT_FALSE(stream.next_of<protocol::Pong>().has_value());
    ASSERT_TRUE(stream.last_control.has_value());
    EXPECT_EQ(stream.last_control->opcode, 8);
    EXPECT_EQ(stream.last_control->bytes.substr(0, 2), c.code);
  }
}

TEST(WebSocketSim, AnswersPingAndClose) {
  RunningServer server;
  StreamPeer stream(server->http_address());
  stream.send_bytes("hello?", 9);
  const auto pong = stream.next_frame();
  ASSERT_TRUE(pong.has_value());
  EXPECT_EQ(pong->opcode, 10);
  EXPECT_EQ(pong->bytes, "hello?");
  stream.send_bytes(std::string("\x03\xe8", 2), 8);
  EXPECT_EQ(stream.next_frame()->opcode, 8);
  EXPECT_TRUE(stream.peer.is_ended_by_other());
}

TEST(WebSocketSim, RefusesWhatIsNoHandshake) {
  RunningServer server;
  const Response plain = get(server->http_address(), "/v1/worlds/default/stream");
  EXPECT_EQ(plain.status, 426);
  EXPECT_EQ(plain.field("Upgrade"), "websocket");
  EXPECT_EQ(get(server->http_address(), "/v1/worlds/none/stream").status, 404);
}

}  // namespace
}  // namespace talus::server
