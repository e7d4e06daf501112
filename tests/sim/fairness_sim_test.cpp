// What one client asks for is not another's delay: a whole server with one terrain thread.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/sim/running_server.hpp"
#include "tests/sim/stream_peer.hpp"

namespace talus::server {
namespace {

Settings one_thread() {
  Settings settings = quiet_settings();
  settings.threads = 1;
  return settings;
}

/// Keeps as many cold chunks queued over HTTP as it has connections, all over the world.
class Scanner {
 public:
  Scanner(const std::string& address, int connections) {
    for (int i = 0; i < connections; ++i) peers_.emplace_back(address);
    for (Peer& peer : peers_) ask(peer);
  }
  void ask(Peer& peer) {
    ++asked_;
    peer.send(get_request("/v1/worlds/default/chunks/0/" + std::to_string(asked_ * 1000) + "/20/7.drc"));
  }
  /// Answers are read in turn and asked again; true when none was lost.
  bool go_on() {
    for (Peer& peer : peers_) {
      const int status = read_response(peer).status;
      if (status != 200 && status != 204 && status != 503) return false;
      ask(peer);
    }
    return true;
  }

 private:
  std::vector<Peer> peers_;
  int asked_ = 0;
};

TEST(FairnessSim, MakesTheFirstChunkOfAStreamBeforeTheQueueOfAScanner) {
  RunningServer server(one_thread());
  StreamPeer stream(server->http_address());
  ASSERT_TRUE(stream.open(kPlenty));
  Scanner scanner(server->http_address(), 60);
  ASSERT_TRUE(scanner.go_on());
  const auto before = server.count(Count::kChunkBuilt);
  protocol::Want want;
  want.chunks.push_back({{0, -500'000, 20, 3}, 0});
  stream.send(want);
  ASSERT_TRUE(stream.next_of<protocol::ChunkHead>().has_value());
  EXPECT_LE(server.count(Count::kChunkBuilt), before + 10) << "sixty were waiting";
}

TEST(FairnessSim, CompletesAViewWhileAScannerNeverStops) {
  RunningServer server(one_thread());
  Scanner scanner(server->http_address(), 20);
  StreamPeer stream(server->http_address());
  ASSERT_TRUE(stream.open(kPlenty));
  stream.look_from(0, 200);
  std::size_t chunks = 0;
  bool is_complete = false;
  while (!is_complete) {
    const auto message = stream.next();
    ASSERT_TRUE(message.has_value()) << "after " << chunks << " chunks";
    chunks += std::holds_alternative<protocol::ChunkHead>(*message) ? 1U : 0U;
    is_complete = std::holds_alternative<protocol::Idle>(*message);
    if (chunks % 50 == 0) {
      ASSERT_TRUE(scanner.go_on());
    }
  }
  EXPECT_GT(chunks, 500U);
}

TEST(FairnessSim, SaysWhenItIsWorthComingAgain) {
  Settings settings = one_thread();
  settings.cold_queue = 4;
  RunningServer server(settings);
  std::vector<Peer> peers;
  for (int i = 0; i < 40; ++i) peers.emplace_back(server->http_address());
  for (std::size_t i = 0; i < peers.size(); ++i) {
    peers[i].send(get_request("/v1/worlds/default/chunks/0/" + std::to_string(i * 1000) + "/20/7.drc"));
  }
  int refused = 0;
  for (Peer& peer : peers) {
    const Response response = read_response(peer);
    if (response.status != 503) continue;
    ++refused;
    EXPECT_EQ(response.field("Retry-After"), "1") << "four chunks take milliseconds";
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace talus::server
