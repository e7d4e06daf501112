// Who may come in: tokens at every door, origins, proxies; and who is put out.
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "client_sample/cli/commands.hpp"
#include "tests/sim/running_server.hpp"
#include "tests/sim/stream_peer.hpp"
#include "tests/support/certificate.hpp"

namespace talus::server {
namespace {

constexpr const char* kManifest = "/v1/worlds/default";
constexpr const char* kChunk = "/v1/worlds/default/chunks/0/0/1000000/0.drc";

/// A key's file, and tokens as `talus token` prints them.
struct Keys {
  std::string file =
      testing::TempDir() + "doors_sim_key_" + testing::UnitTest::GetInstance()->current_test_info()->name();

  Keys() { std::ofstream(file) << "0123456789abcdef0123456789abcdef\n"; }

  std::string token(const std::string& world, double hours = 1) const {
    cli::TokenOptions options;
    options.key_file = file;
    options.world = world;
    options.hours = hours;
    testing::internal::CaptureStdout();
    EXPECT_EQ(cli::token(options), cli::kDone);
    std::string out = testing::internal::GetCapturedStdout();
    while (out.ends_with('\n')) out.pop_back();
    return out;
  }
};

Settings guarded(const Keys& keys) {
  Settings settings = quiet_settings();
  settings.token_keys = {keys.file};
  return settings;
}

std::string bearer(const std::string& token) {
  return "Authorization: Bearer " + token + "\r\n";
}

TEST(TokenSim, HttpIsReadWithATokenOfThisWorldOnly) {
  const Keys keys;
  RunningServer server(guarded(keys));
  const std::string& http = server->http_address();
  const std::string good = keys.token("default");

  const Response without = get(http, kManifest);
  EXPECT_EQ(without.status, 401);
  EXPECT_EQ(without.field("WWW-Authenticate"), "Bearer realm=\"talus\"");
  EXPECT_NE(without.body.find("token_missing"), std::string::npos) << without.body;
  EXPECT_EQ(get(http, kManifest, bearer(good)).status, 200);
  EXPECT_EQ(get(http, kManifest + ("?token=" + good)).status, 200);
  EXPECT_EQ(get(http, kChunk, bearer("nonsense")).status, 401);
  EXPECT_EQ(get(http, kChunk, bearer(keys.token("alps"))).status, 403);
  EXPECT_EQ(get(http, kChunk, bearer(keys.token("default", -1))).status, 401);

  const Response chunk = get(http, kChunk, bearer(good));
  EXPECT_EQ(chunk.status, 204);
  EXPECT_EQ(chunk.field("Cache-Control"), "private, max-age=31536000, immutable") << "no shared cache may give it on";
  EXPECT_EQ(get(http, kChunk, "If-None-Match: " + chunk.field("ETag") + "\r\n").status, 401) << "not even 304";

  EXPECT_EQ(get(http, "/healthz").status, 200);
  EXPECT_EQ(get(http, "/v1/worlds").status, 200);
  EXPECT_EQ(server.count(Count::kTokenMissing), 2U);
  EXPECT_EQ(server.count(Count::kTokenBad), 1U);
  EXPECT_EQ(server.count(Count::kTokenOtherWorld), 1U);
  EXPECT_EQ(server.count(Count::kTokenExpired), 1U);
}

TEST(TokenSim, AStreamIsOpenedByItsUrlOrByItsHello) {
  const Keys keys;
  RunningServer server(guarded(keys));
  const auto hello = [&](StreamPeer& peer, const std::string& token) {
    protocol::Hello message;
    message.version_low = message.version_high = 1;
    message.world = "default";
    message.token = token;
    peer.send(message);
    return peer.next();
  };
  for (const auto carrier : {StreamPeer::Carrier::kWebSocket, StreamPeer::Carrier::kTcp}) {
    const std::string& address = carrier == StreamPeer::Carrier::kTcp ? server->tcp_address() : server->http_address();
    StreamPeer good(address, carrier);
    const auto welcome = hello(good, keys.token("default"));
    ASSERT_TRUE(welcome.has_value());
    EXPECT_TRUE(std::holds_alternative<protocol::Welcome>(*welcome));
    for (const std::string& bad : {std::string(), std::string("nonsense"), keys.token("alps")}) {
      StreamPeer stranger(address, carrier);
      const auto answer = hello(stranger, bad);
      ASSERT_TRUE(answer.has_value());
      const auto* refused = std::get_if<protocol::Refused>(&*answer);
      ASSERT_NE(refused, nullptr);
      EXPECT_EQ(refused->reason, protocol::RefusedReason::kToken);
      EXPECT_NE(refused->message.find("token"), std::string::npos);
    }
  }
  const std::string upgrade =
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  EXPECT_EQ(get(server->http_address(), "/v1/worlds/default/stream?token=" + keys.token("default"), upgrade).status,
            101);
  EXPECT_EQ(get(server->http_address(), "/v1/worlds/default/stream?token=nonsense", upgrade).status, 401);
}

TEST(TokenSim, PregenGoesToAServerWithATokenAndACertificateOfItsOwn) {
  const Keys keys;
  const auto files = test::make_certificate(testing::TempDir() + "doors_sim_pregen");
  Settings settings = guarded(keys);
  settings.tls_certificate = files.certificate;
  settings.tls_key = files.key;
  RunningServer server(settings);
  cli::PregenOptions options;
  options.server.url = "https://" + server->http_address();
  options.server.ca_file = files.certificate;
  options.area = "0,0,0.5";
  options.lod_low = options.lod_high = 5;
  EXPECT_EQ(cli::pregen(options), cli::kFailed) << "without a token";
  options.server.token = keys.token("default");
  EXPECT_EQ(cli::pregen(options), cli::kDone);
  EXPECT_GT(server.count(Count::kChunksSent), 0U);
}

TEST(OriginSim, OnlyPagesOfNamedOriginsStreamAndRead) {
  Settings settings = quiet_settings();
  settings.allowed_origins = {"https://maps.example.org"};
  RunningServer server(settings);
  const std::string& http = server->http_address();
  const std::string upgrade =
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  const std::string stream = "/v1/worlds/default/stream";
  EXPECT_EQ(get(http, stream, upgrade).status, 101);
  EXPECT_EQ(get(http, stream, upgrade + "Origin: https://maps.example.org\r\n").status, 101);
  const Response refused = get(http, stream, upgrade + "Origin: https://evil.example\r\n");
  EXPECT_EQ(refused.status, 403);
  EXPECT_NE(refused.body.find("origin_not_allowed"), std::string::npos);
  EXPECT_EQ(server.count(Count::kOriginRefused), 1U);
  const Response read = get(http, "/v1/worlds", "Origin: https://maps.example.org\r\n");
  EXPECT_EQ(read.field("Access-Control-Allow-Origin"), "https://maps.example.org");
  EXPECT_EQ(read.field("Vary"), "Origin");
  EXPECT_EQ(get(http, "/v1/worlds", "Origin: https://evil.example\r\n").field("Access-Control-Allow-Origin"), "");
  RunningServer open_to_all;
  EXPECT_EQ(get(open_to_all->http_address(), "/v1/worlds").field("Access-Control-Allow-Origin"), "*");
}

TEST(ProxySim, StreamsBehindAProxyCountForTheirOwnAddress) {
  Settings settings = quiet_settings();
  settings.limits.connections_per_address = 2;
  settings.trusted_proxies = {"127.0.0.1"};
  RunningServer server(settings);
  std::vector<Peer> open;
  const auto status_of = [&](const std::string& client) {
    Peer& peer = open.emplace_back(server->http_address());
    peer.send(get_request("/v1/worlds/default/stream",
                          "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                          "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nX-Forwarded-For: " +
                              client + "\r\n"));
    return read_response(peer).status;
  };
  open.reserve(16);
  EXPECT_EQ(status_of("1.2.3.4"), 101);
  EXPECT_EQ(status_of("9.9.9.9, 1.2.3.4"), 101);
  EXPECT_EQ(status_of("1.2.3.4"), 429) << "a third of one address";
  EXPECT_EQ(status_of("5.6.7.8"), 101) << "another's own";
  EXPECT_EQ(server.count(Count::kConnectionsRefusedAddress), 1U);
}

TEST(ProxySim, TheFieldOfAPeerThatIsNoProxyChangesNothing) {
  Settings settings = quiet_settings();
  settings.limits.connections_per_address = 2;
  RunningServer server(settings);
  Peer first(server->http_address());
  Peer second(server->http_address());
  for (Peer* peer : {&first, &second}) {
    peer->send(get_request("/healthz", "X-Forwarded-For: 1.2.3.4\r\n"));
    EXPECT_EQ(read_response(*peer).status, 200);
  }
  EXPECT_EQ(get(server->http_address(), "/healthz", "X-Forwarded-For: 5.6.7.8\r\n").status, 503);
}

TEST(SlowSim, AMessageThatTricklesInIsGivenUpWithItsReason) {
  Settings settings = quiet_settings();
  settings.limits.message_s = 0.4;
  RunningServer server(settings);
  StreamPeer peer(server->tcp_address(), StreamPeer::Carrier::kTcp);
  ASSERT_TRUE(peer.open(1'000'000));
  peer.peer.send(std::string("\x20\x00\x00\x00half", 8));
  const auto bye = peer.next_of<protocol::Bye>();
  ASSERT_TRUE(bye.has_value());
  EXPECT_NE(bye->message.find("message_s"), std::string::npos);
  EXPECT_EQ(server.count(Count::kMessageTimeout), 1U);

  StreamPeer web(server->http_address());
  ASSERT_TRUE(web.open(1'000'000));
  web.peer.send(std::string("\x82\xA0\x00\x00\x00\x00half", 10));
  EXPECT_TRUE(web.next_of<protocol::Bye>().has_value());
}

TEST(SlowSim, PingsBetweenThePartsOfAMessageGainItNoTime) {
  Settings settings = quiet_settings();
  settings.limits.message_s = 0.5;
  settings.limits.messages_per_s = 1000;
  RunningServer server(settings);
  StreamPeer web(server->http_address());
  ASSERT_TRUE(web.open(1'000'000));
  web.peer.send(std::string("\x02\x82\x00\x00\x00\x00hi", 8));  // the first part of two
  // As long as the server goes on with us: without an end this would be a minute of pings.
  for (int i = 0; i < 1200 && server.count(Count::kMessageTimeout) == 0; ++i) {
    web.send_bytes("p", 9);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_EQ(server.count(Count::kMessageTimeout), 1U);
  EXPECT_TRUE(web.next_of<protocol::Bye>().has_value());
}

}  // namespace
}  // namespace talus::server
