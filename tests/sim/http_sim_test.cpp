// A whole server, asked over raw sockets.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim/peer.hpp"
#include "tests/sim/running_server.hpp"

namespace talus::server {
namespace {

/// A chunk of the default world with a surface, found from the height of the ground.
std::string surface_chunk(const std::string& http, int lod, int x, int z) {
  for (int y = -40; y < 120; ++y) {
    const std::string target = "/v1/worlds/default/chunks/" + std::to_string(lod) + "/" + std::to_string(x) + "/" +
                               std::to_string(y) + "/" + std::to_string(z) + ".drc";
    if (get(http, target).status == 200) return target;
  }
  return {};
}

/// A peer for each of `count` chunks that nobody has asked for, with its request sent.
std::vector<Peer> ask_for_cold_chunks(const std::string& http, std::size_t count) {
  std::vector<Peer> peers;
  for (std::size_t i = 0; i < count; ++i) peers.emplace_back(http);
  for (std::size_t i = 0; i < count; ++i) {
    peers[i].send(get_request("/v1/worlds/default/chunks/6/" + std::to_string(i * 100) + "/0/0.drc"));
  }
  return peers;
}

TEST(HttpSim, AnswersEveryDoorOfAFreshServer) {
  RunningServer server;
  const std::string http = server->http_address();
  EXPECT_EQ(get(http, "/healthz").body, "ok\n");
  EXPECT_EQ(get(http, "/readyz").status, 200);
  EXPECT_NE(get(http, "/v1/worlds").body.find("\"default\""), std::string::npos);
  const Response manifest = get(http, "/v1/worlds/default");
  EXPECT_NE(manifest.body.find("\"world_hash\""), std::string::npos);
  EXPECT_EQ(get(http, "/v1/worlds/default", "If-None-Match: " + manifest.field("ETag") + "\r\n").status, 304);
  EXPECT_NE(get(server->admin_address(), "/metrics").body.find("talus_hop_seconds_bucket"), std::string::npos);
  EXPECT_EQ(get(http, "/v1/worlds/default/spawn?near=0,0").body.substr(0, 5), "{\"x\":");
  EXPECT_NE(get(http, "/v1/worlds/default/points?xz=0,0;1000,5").body.find("\"material\""), std::string::npos);
}

TEST(HttpSim, ServesAChunkForEverAndSaysNotModifiedWithoutWork) {
  RunningServer server;
  const std::string target = surface_chunk(server->http_address(), 5, 0, 0);
  ASSERT_FALSE(target.empty());
  const Response first = get(server->http_address(), target);
  EXPECT_EQ(first.body.substr(0, 5), "DRACO");
  EXPECT_EQ(first.field("Cache-Control"), "public, max-age=31536000, immutable");
  EXPECT_EQ(first.field("Talus-Chunk"), "mesh");
  EXPECT_EQ(get(server->http_address(), target).body, first.body);
  const auto built = server.count(Count::kChunkBuilt);
  const auto hits = server.count(Count::kChunkHit);
  EXPECT_EQ(get(server->http_address(), target, "If-None-Match: " + first.field("ETag") + "\r\n").status, 304);
  const std::string unseen = "/v1/worlds/default/chunks/0/77777/3/5.drc";
  EXPECT_EQ(get(server->http_address(), unseen, "If-None-Match: " + first.field("ETag") + "\r\n").status, 304);
  EXPECT_EQ(server.count(Count::kChunkBuilt), built);
  EXPECT_EQ(server.count(Count::kChunkHit), hits);
}

TEST(HttpSim, SaysWhatFillsAChunkWithoutSurface) {
  RunningServer server;
  const Response air = get(server->http_address(), "/v1/worlds/default/chunks/0/0/1000000/0.drc");
  EXPECT_EQ(air.status, 204);
  EXPECT_EQ(air.field("Talus-Chunk"), "air");
  const Response rock = get(server->http_address(), "/v1/worlds/default/chunks/0/0/-1000000/0.glb");
  EXPECT_EQ(rock.field("Talus-Chunk"), "rock");
}

TEST(HttpSim, AnswersHeadWithTheFieldsOfGetAndNoBody) {
  RunningServer server;
  const std::string target = surface_chunk(server->http_address(), 5, 0, 0);
  const Response full = get(server->http_address(), target);
  Peer peer(server->http_address());
  peer.send("HEAD " + target + " HTTP/1.1\r\nHost: a\r\n\r\n" + get_request("/healthz"));
  const Response head = read_response(peer, false);
  EXPECT_EQ(head.field("Content-Length"), full.field("Content-Length"));
  EXPECT_EQ(head.field("ETag"), full.field("ETag"));
  EXPECT_EQ(read_response(peer).body, "ok\n") << "the next answer follows at once";
}

TEST(HttpSim, AnswersPipelinedRequestsInOrder) {
  RunningServer server;
  Peer peer(server->http_address());
  std::string wire;
  for (int i = 0; i < 50; ++i) wire += get_request(i % 2 == 0 ? "/healthz" : "/v1/worlds/none");
  peer.send(wire);
  for (int i = 0; i < 50; ++i) ASSERT_EQ(read_response(peer).status, i % 2 == 0 ? 200 : 404) << i;
}

TEST(HttpSim, ReadsARequestThatComesByteByByte) {
  RunningServer server;
  Peer peer(server->http_address());
  for (const char c : get_request("/healthz")) peer.send(std::string_view(&c, 1));
  EXPECT_EQ(read_response(peer).status, 200);
}

TEST(HttpSim, AnswersAndClosesOnRequestsThatSmuggle) {
  RunningServer server;
  struct Case {
    std::string wire;
    int status;
  };
  const std::string host = "Host: a\r\n";
  const std::vector<Case> kTable{
      {"GET / HTTP/1.1\r\n" + host + host + "\r\n", 400},
      {"POST / HTTP/1.1\r\n" + host + "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400},
      {"GET / HTTP/1.1\nHost: a\n\n", 400},
      {"GET / HTTP/1.1\r\n" + host + "A: b\r\n c\r\n\r\n", 400},
      {"GET /" + std::string(10'000, 'a') + " HTTP/1.1\r\n" + host + "\r\n", 414},
      {"GET / HTTP/1.1\r\n" + host + "A: " + std::string(20'000, 'a') + "\r\n\r\n", 431},
      {"POST /healthz HTTP/1.1\r\n" + host + "Content-Length: 99999999\r\n\r\n", 413},
      {"\x16\x03\x01\x02", 400},
  };
  for (const Case& c : kTable) {
    Peer peer(server->http_address());
    // What follows must never be taken for a request of its own.
    peer.send(c.wire + get_request("/healthz"));
    const Response response = read_response(peer);
    EXPECT_EQ(response.status, c.status) << c.wire.substr(0, 60);
    EXPECT_EQ(response.field("Connection"), "close");
    EXPECT_EQ(read_response(peer).status, 0);
  }
}

TEST(HttpSim, NeverTakesABodyForARequest) {
  RunningServer server;
  Peer peer(server->http_address());
  const std::string inner = get_request("/healthz");
  peer.send("POST /v1/worlds HTTP/1.1\r\nHost: a\r\nContent-Length: " + std::to_string(inner.size()) + "\r\n\r\n" +
            inner);
  const Response response = read_response(peer);
  EXPECT_EQ(response.status, 405);
  EXPECT_EQ(response.field("Allow"), "GET, HEAD, OPTIONS");
  EXPECT_EQ(read_response(peer).status, 0);
}

TEST(HttpSim, OutlivesPeersThatGoAwayAtAnyPoint) {
  RunningServer server;
  const std::string whole = get_request("/v1/worlds/default/chunks/3/0/1/0.drc");
  for (std::size_t size = 0; size <= whole.size(); size += 3) Peer(server->http_address()).send(whole.substr(0, size));
  EXPECT_EQ(get(server->http_address(), "/healthz").status, 200);
  EXPECT_TRUE(eventually([&] {
    return get(server->admin_address(), "/metrics").body.find("talus_connections 0\n") != std::string::npos;
  }));
}

TEST(HttpSim, ClosesConnectionsThatAreSilentSlowOrIdle) {
  Settings settings = quiet_settings();
  settings.limits.silent_s = 0.2;
  settings.limits.head_s = 0.3;
  settings.limits.idle_s = 0.2;
  RunningServer server(settings);
  Peer silent(server->http_address());
  Peer slow(server->http_address());
  slow.send("GET / HT");
  Peer idle(server->http_address());
  idle.send(get_request("/healthz"));
  EXPECT_EQ(read_response(idle).status, 200);
  EXPECT_TRUE(silent.is_ended_by_other());
  EXPECT_TRUE(slow.is_ended_by_other());
  EXPECT_TRUE(idle.is_ended_by_other());
  EXPECT_EQ(server.count(Count::kSilentTimeout), 1U);
  EXPECT_EQ(server.count(Count::kHeadTimeout), 1U);
  EXPECT_EQ(server.count(Count::kIdleTimeout), 1U);
}

TEST(HttpSim, EndsAConnectionAfterItsRequests) {
  Settings settings = quiet_settings();
  settings.limits.requests_per_connection = 3;
  RunningServer server(settings);
  Peer peer(server->http_address());
  for (int i = 0; i < 4; ++i) peer.send(get_request("/healthz"));
  EXPECT_EQ(read_response(peer).field("Connection"), "");
  EXPECT_EQ(read_response(peer).field("Connection"), "");
  EXPECT_EQ(read_response(peer).field("Connection"), "close");
  EXPECT_EQ(read_response(peer).status, 0);
}

TEST(HttpSim, NamesEveryAnswerByItsRequest) {
  RunningServer server;
  const std::string& http = server->http_address();
  EXPECT_EQ(get(http, "/healthz", "X-Request-Id: from-the-proxy.1\r\n").field("X-Request-Id"), "from-the-proxy.1");
  Peer peer(http);
  peer.send(get_request("/healthz") + get_request("/v1/nothing") + get_request("/v1/worlds/default/spawn"));
  std::set<std::string> made;
  for (int i = 0; i < 3; ++i) made.insert(read_response(peer).field("X-Request-Id"));
  EXPECT_EQ(made.size(), 3U);
  EXPECT_FALSE(made.contains(""));
  Peer refused(http);
  refused.send("nonsense\r\n\r\n");
  EXPECT_EQ(read_response(refused).field("X-Request-Id").size(), 16U);
  EXPECT_EQ(get(http, "/healthz", "X-Request-Id: \"quoted\"\r\n").field("X-Request-Id").size(), 16U);
  const Response stream = get(http, "/v1/worlds/default/stream",
                              "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nX-Request-Id: mine\r\n");
  EXPECT_EQ(stream.status, 101);
  EXPECT_EQ(stream.field("X-Request-Id"), "mine");
}

TEST(HttpSim, CountsWhatWasInMemoryAndWhatWasMade) {
  RunningServer server;
  const std::string target = surface_chunk(server->http_address(), 4, 9, 9);
  const auto from_pool = server.count(Count::kHttpChunkFromPool);
  const auto in_memory = server.count(Count::kHttpChunkInMemory);
  const Response again = get(server->http_address(), target);
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(server.count(Count::kHttpChunkInMemory), in_memory + 1);
  EXPECT_EQ(server.count(Count::kHttpChunkFromPool), from_pool);
  EXPECT_GT(from_pool, 0U);
  EXPECT_GE(server.count(Count::kHttpBodyBytes), again.body.size());
}

TEST(HttpSim, LetsOneClientHaveOnlySoMuchWaiting) {
  Settings settings = quiet_settings();
  settings.threads = 1;
  settings.cold_per_client = 2;
  RunningServer server(settings);
  std::vector<Peer> peers = ask_for_cold_chunks(server->http_address(), 30);
  std::uint64_t refused = 0;
  for (Peer& peer : peers) refused += read_response(peer).status == 503 ? 1U : 0U;
  EXPECT_GT(refused, 0U);
  EXPECT_EQ(server.count(Count::kChunkOverShare), refused);
  EXPECT_EQ(server.count(Count::kChunkShed), 0U);
}

TEST(HttpSim, TurnsAwayConnectionsBeyondItsLimits) {
  Settings settings = quiet_settings();
  settings.limits.connections_per_address = 3;
  RunningServer server(settings);
  std::vector<Peer> peers;
  for (int i = 0; i < 3; ++i) {
    peers.emplace_back(server->http_address());
    peers.back().send(get_request("/healthz"));
    EXPECT_EQ(read_response(peers.back()).status, 200);
  }
  Peer fourth(server->http_address());
  EXPECT_EQ(read_response(fourth).status, 503);
  peers.clear();
  EXPECT_TRUE(eventually([&] { return get(server->http_address(), "/healthz").status == 200; }));
  EXPECT_GE(server.count(Count::kConnectionsRefusedAddress), 1U);
}

TEST(HttpSim, MakesAColdChunkOnceForAllWhoAskAtOnce) {
  RunningServer server;
  const std::string target = surface_chunk(server->http_address(), 4, 9, 9);
  RunningServer cold;
  std::vector<Peer> peers;
  for (int i = 0; i < 32; ++i) peers.emplace_back(cold->http_address());
  for (Peer& peer : peers) peer.send(get_request(target));
  std::string body;
  for (Peer& peer : peers) {
    const Response response = read_response(peer);
    EXPECT_EQ(response.status, 200);
    if (body.empty()) body = response.body;
    EXPECT_EQ(response.body, body);
  }
  EXPECT_EQ(cold.count(Count::kChunkBuilt), 1U);
}

TEST(HttpSim, ShedsColdWorkBeyondItsQueueAndSaysWhenToComeAgain) {
  Settings settings = quiet_settings();
  settings.threads = 1;
  settings.cold_queue = 2;
  RunningServer server(settings);
  std::vector<Peer> peers = ask_for_cold_chunks(server->http_address(), 40);
  int shed = 0;
  for (Peer& peer : peers) {
    const Response response = read_response(peer);
    if (response.status != 503) continue;
    ++shed;
    EXPECT_EQ(response.field("Retry-After"), "1");
    EXPECT_NE(response.body.find("\"busy\""), std::string::npos);
  }
  EXPECT_GT(shed, 0);
  EXPECT_EQ(server.count(Count::kChunkShed), static_cast<std::uint64_t>(shed));
}

TEST(HttpSim, AllowsReadsFromEveryOrigin) {
  RunningServer server;
  Peer peer(server->http_address());
  peer.send("OPTIONS /v1/worlds HTTP/1.1\r\nHost: a\r\nOrigin: http://b\r\nAccess-Control-Request-Method: GET\r\n\r\n");
  const Response preflight = read_response(peer);
  EXPECT_EQ(preflight.status, 204);
  EXPECT_EQ(preflight.field("Access-Control-Allow-Origin"), "*");
  EXPECT_EQ(preflight.field("Access-Control-Allow-Methods"), "GET, HEAD, OPTIONS");
}

TEST(HttpSim, SaysWhoHasThePortWhenItIsTaken) {
  RunningServer server;
  Settings settings = quiet_settings();
  settings.listen = server->http_address();
  const auto second = Server::start(settings);
  ASSERT_FALSE(second.has_value());
  EXPECT_NE(second.error().find(server->http_address() + ": Address already in use"), std::string::npos);
}

}  // namespace
}  // namespace talus::server
