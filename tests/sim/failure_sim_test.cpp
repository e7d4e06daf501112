// Chunks that cannot be made: by a job that throws, and by one that never comes back.
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <thread>

#include "server/observe/log.hpp"
#include "tests/sim/made_up_server.hpp"
#include "tests/sim/stream_peer.hpp"
#include "tests/support/gate.hpp"

namespace talus::server {
namespace {

constexpr ChunkKey kThrows{3, 1, 0, 0};
constexpr ChunkKey kHangs{3, 2, 0, 0};
constexpr ChunkKey kGood{3, 3, 0, 0};

class FaultyBuilder final : public ChunkBuilder {
 public:
  std::optional<ChunkPayload> build(const PayloadName& name, std::size_t, const CancelToken&) override {
    if (name.key == kThrows) throw std::runtime_error("as the test wants it");
    if (name.key == kHangs) gate_.wait();
    return ChunkPayload{ChunkKind::kAir, {}};
  }
  void open() { gate_.open(); }

 private:
  test::Gate gate_;
};

class FailureSim : public testing::Test {
 protected:
  FailureSim() { set_log_level(LogLevel::kOff); }
  ~FailureSim() override { builder.open(); }

  StreamPeer stream(StreamPeer::Carrier carrier) {
    return StreamPeer(carrier == StreamPeer::Carrier::kTcp ? server.tcp_address : server.http_address, carrier);
  }

  FaultyBuilder builder;
  MadeUpServer server{builder, 0.5};
};

std::string path_of(const ChunkKey& key) {
  return "/v1/worlds/default/chunks/" + std::to_string(key.lod) + "/" + std::to_string(key.x) + "/" +
         std::to_string(key.y) + "/" + std::to_string(key.z) + ".drc";
}

struct Told {
  std::multiset<ChunkKey> came;
  std::multiset<ChunkKey> failed;
  bool is_idle = false;
};

/// What a stream says of a want of all three, until it is idle.
Told want_all(StreamPeer& peer) {
  peer.send(protocol::Want{{{kThrows, 0}, {kHangs, 0}, {kGood, 0}}});
  Told out;
  while (!out.is_idle) {
    const auto message = peer.next();
    if (!message) break;
    if (const auto* chunk = std::get_if<protocol::ChunkHead>(&*message)) out.came.insert(chunk->key);
    if (const auto* failed = std::get_if<protocol::Failed>(&*message)) out.failed.insert(failed->key);
    out.is_idle = std::holds_alternative<protocol::Idle>(*message);
  }
  return out;
}

TEST_F(FailureSim, AStreamIsToldWhatCannotBeMadeAndGetsTheRest) {
  for (const auto carrier : {StreamPeer::Carrier::kTcp, StreamPeer::Carrier::kWebSocket}) {
    StreamPeer peer = stream(carrier);
    ASSERT_TRUE(peer.open(1'000'000, protocol::kVersionOfFailures));
    const Told told = want_all(peer);
    EXPECT_TRUE(told.is_idle);
    EXPECT_EQ(told.came, (std::multiset<ChunkKey>{kGood}));
    EXPECT_EQ(told.failed, (std::multiset<ChunkKey>{kThrows, kHangs}));
  }
  EXPECT_EQ(server.count(Count::kChunkHung), 1U) << "the second stream's want cost no other thread";
}

TEST_F(FailureSim, AStreamOfAnEarlierVersionIsToldNothingAndBecomesIdle) {
  StreamPeer peer = stream(StreamPeer::Carrier::kTcp);
  ASSERT_TRUE(peer.open(1'000'000, protocol::kVersionOfStrips));
  const Told told = want_all(peer);
  EXPECT_TRUE(told.is_idle);
  EXPECT_EQ(told.came, (std::multiset<ChunkKey>{kGood}));
  EXPECT_TRUE(told.failed.empty());
}

TEST_F(FailureSim, HttpAnswersThatItCannotBeMadeAndServesTheOthers) {
  for (const ChunkKey& key : {kThrows, kHangs, kHangs}) {
    const Response response = get(server.http_address, path_of(key));
    EXPECT_EQ(response.status, 503);
    EXPECT_NE(response.body.find("chunk_failed"), std::string::npos) << response.body;
    EXPECT_NE(response.field("Retry-After"), "");
  }
  EXPECT_EQ(get(server.http_address, path_of(kGood)).status, 204);
  EXPECT_EQ(server.pool.hung(), 1U);
  EXPECT_EQ(server.pool.threads(), 1U);

  builder.open();
  while (server.pool.hanging() != 0) std::this_thread::yield();
  EXPECT_EQ(get(server.http_address, path_of(kHangs)).status, 204) << "it came back after all";
}

}  // namespace
}  // namespace talus::server
