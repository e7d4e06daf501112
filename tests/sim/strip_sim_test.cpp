// Strips, from a whole server over raw sockets: those a view needs come by themselves, others by name.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/sim/running_server.hpp"
#include "tests/sim/stream_peer.hpp"

namespace talus::server {
namespace {

constexpr std::uint64_t kStripCredit = std::uint64_t{1} << 40;

/// Strips and chunks with a surface that came until idle.
struct Closed {
  std::vector<StripKey> strips;
  std::map<ChunkKey, unsigned> faces;
  std::set<ChunkKey> chunks;
};
Closed read_closed(StreamPeer& stream) {
  Closed out;
  while (auto message = stream.next()) {
    if (std::holds_alternative<protocol::Idle>(*message)) break;
    if (const auto* strip = std::get_if<protocol::StripHead>(&*message)) out.strips.push_back(strip->strip);
    const auto* chunk = std::get_if<protocol::ChunkHead>(&*message);
    if (chunk == nullptr) continue;
    out.chunks.insert(chunk->key);
    if (chunk->faces != 0) out.faces[chunk->key] = chunk->faces;
  }
  std::sort(out.strips.begin(), out.strips.end());
  return out;
}

class StripSim : public testing::TestWithParam<StreamPeer::Carrier> {
 protected:
  StreamPeer connect(RunningServer& server) {
    return {GetParam() == StreamPeer::Carrier::kTcp ? server->tcp_address() : server->http_address(), GetParam()};
  }
};
INSTANTIATE_TEST_SUITE_P(Carriers, StripSim,
                         testing::Values(StreamPeer::Carrier::kWebSocket, StreamPeer::Carrier::kTcp));

TEST_P(StripSim, SendsExactlyTheStripsThatAViewNeedsToClientsThatKnowThem) {
  RunningServer server;
  StreamPeer stream = connect(server);
  ASSERT_TRUE(stream.open(kStripCredit, protocol::kVersionOfStrips));
  stream.look_from(0, 700);
  const Closed view = read_closed(stream);
  std::set<StripKey> needed;
  for (const auto& [key, faces] : view.faces) {
    for (const ChunkFace face : kAllChunkFaces) {
      const ChunkKey across = parent_of(neighbour_of(key, face));
      if ((faces & bit_of(face)) != 0 && view.chunks.contains(across)) needed.insert({across, opposite(face)});
    }
  }
  EXPECT_GT(needed.size(), 5U);
  EXPECT_EQ(view.strips, std::vector<StripKey>(needed.begin(), needed.end()));

  StreamPeer old = connect(server);
  ASSERT_TRUE(old.open(kStripCredit));
  old.look_from(0, 700);
  const Closed without = read_closed(old);
  EXPECT_EQ(without.chunks, view.chunks);
  EXPECT_TRUE(without.strips.empty());
}

TEST_P(StripSim, SendsNoStripBetweenChunksOfOneLodAndAnEmptyOneWhereNothingIsFiner) {
  RunningServer server;
  for (const std::string& format : {std::string("drc"), std::string("mesh")}) {
    StreamPeer stream = connect(server);
    protocol::Hello hello;
    hello.version_low = hello.version_high = protocol::kVersionOfStrips;
    hello.world = "default";
    hello.formats = {format};
    hello.credit_bytes = kStripCredit;
    stream.send(hello);
    ASSERT_TRUE(stream.next_of<protocol::Welcome>());
    // Two stacks of chunks side by side: their surfaces meet in faces between equals.
    protocol::Want equals;
    for (std::int32_t y = -3; y < 4; ++y) {
      equals.chunks.push_back({{4, 5, y, 5}, 0});
      equals.chunks.push_back({{4, 6, y, 5}, 0});
    }
    stream.send(equals);
    const Closed got = read_closed(stream);
    EXPECT_EQ(got.chunks.size(), equals.chunks.size());
    EXPECT_TRUE(std::ranges::any_of(got.faces, [](const auto& chunk) {
      return chunk.first.x == 5 && (chunk.second & bit_of(ChunkFace::kPx)) != 0;
    }));
    EXPECT_TRUE(got.strips.empty());

    // By name: whatever lies there, LOD 0 has nothing finer beside it.
    protocol::Want named;
    for (const ChunkFace face : kAllChunkFaces) named.strips.push_back({{0, 0, 7, 0}, face});
    stream.send(named);
    std::size_t empty = 0;
    while (const auto message = stream.next()) {
      if (std::holds_alternative<protocol::Idle>(*message)) break;
      const auto* strip = std::get_if<protocol::StripHead>(&*message);
      if (strip == nullptr) continue;
      EXPECT_EQ(strip->strip.key.lod, 0);
      EXPECT_TRUE(stream.payload.empty());
      ++empty;
    }
    EXPECT_EQ(empty, named.strips.size()) << "answered, each";
    stream.look_from(0, 300);
    EXPECT_TRUE(stream.next_of<protocol::Idle>()) << "and the stream goes on";
  }
}

}  // namespace
}  // namespace talus::server
