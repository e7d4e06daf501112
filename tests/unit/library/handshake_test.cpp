#include "client_sample/library/handshake.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client_sample/library/world_info.hpp"
#include "core/world/manifest.hpp"
#include "protocol/manifest_toml.hpp"
#include "protocol/websocket_accept.hpp"

namespace talus::client {
namespace {

using testing::HasSubstr;

TEST(WebsocketAccept, IsThatOfTheStandard) {
  EXPECT_EQ(protocol::websocket_accept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

TEST(Handshake, AsksForAWebSocket) {
  const std::string request = handshake_request({"::1", 8080, "/behind"}, "/v1/worlds/w/stream", "KEY");
  EXPECT_THAT(request, testing::StartsWith("GET /behind/v1/worlds/w/stream HTTP/1.1\r\nHost: [::1]:8080\r\n"));
  EXPECT_THAT(request, HasSubstr("Sec-WebSocket-Key: KEY\r\n"));
  EXPECT_THAT(request, testing::EndsWith("\r\n\r\n"));
}

TEST(Handshake, HasAFreshKeyOfSixteenBytes) {
  const std::string key = handshake_key(1, 2);
  EXPECT_EQ(key.size(), 24U);
  EXPECT_NE(key, handshake_key(1, 3));
}

std::string answer(const std::string& accept, const std::string& more = "") {
  return "HTTP/1.1 101 Switching Protocols\r\nupgrade: WebSocket\r\nConnection: keep-alive, Upgrade\r\n"
         "Sec-WebSocket-Accept:  " +
         accept + "\r\n" + more + "\r\n";
}

TEST(Handshake, TakesOnlyTheAnswerToItsKey) {
  const std::string good = protocol::websocket_accept("KEY");
  EXPECT_FALSE(handshake_fault(answer(good), "KEY"));
  EXPECT_TRUE(handshake_fault(answer("AAAA"), "KEY"));
  EXPECT_TRUE(handshake_fault(answer(good, "Sec-WebSocket-Extensions: permessage-deflate\r\n"), "KEY"));
  EXPECT_TRUE(handshake_fault("HTTP/1.1 200 OK\r\n\r\n", "KEY"));
  EXPECT_TRUE(handshake_fault("HTTP/1.0 101 Hm\r\n\r\n", "KEY"));
  EXPECT_TRUE(handshake_fault("HTTP/1.1 101 Switching Protocols\r\n\r\n", "KEY"));
  EXPECT_TRUE(handshake_fault("", "KEY"));
}

TEST(Handshake, SaysWhatTheServerSaid) {
  const auto error = handshake_fault("HTTP/1.1 404 Not Found\r\nA: b\r\n\r\n{\"message\":\"no such world\"}", "KEY");
  ASSERT_TRUE(error);
  EXPECT_THAT(error->message, HasSubstr("404 Not Found"));
  EXPECT_THAT(error->message, HasSubstr("no such world"));
}

TEST(ServerUrl, IsReadOrRefusedWithAReason) {
  const auto plain = parse_server_url("http://example.org");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->authority(), "example.org:80");
  const auto v6 = parse_server_url("http://[::1]:9/talus/");
  ASSERT_TRUE(v6);
  EXPECT_EQ(v6->host, "::1");
  EXPECT_EQ(v6->port, 9);
  EXPECT_EQ(v6->prefix, "/talus");
  const auto tcp = parse_server_url("tcp://example.org");
  ASSERT_TRUE(tcp);
  EXPECT_EQ(tcp->authority(), "example.org:8081");
  EXPECT_EQ(tcp->carrier, Carrier::kTcp);
  const auto secure = parse_server_url("wss://example.org/talus");
  ASSERT_TRUE(secure);
  EXPECT_TRUE(secure->is_secure && !plain->is_secure);
  EXPECT_EQ(secure->authority(), "example.org:443");
  EXPECT_EQ(parse_server_url("tls://example.org")->port, 8081);
  EXPECT_TRUE(parse_server_url("tls://example.org")->is_secure);
  for (const char* bad : {"", "example.org", "ftp://example.org", "tcp://a/path", "tcp://", "tcp://a:0", "http://",
                          "http://:80", "http://a:0", "http://a:65536", "http://a:+1", "http://a:", "http://a b",
                          "http://a/?q", "http://u@a", "http://a\r\nX: y"}) {
    const auto refused = parse_server_url(bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().code, ErrorCode::kUrl);
  }
}

TEST(WorldInfo, ReadsTheManifestThatServersSend) {
  const auto info = parse_world_info(protocol::manifest_json(Manifest{}));
  ASSERT_TRUE(info);
  EXPECT_EQ(info->name, "default");
  EXPECT_EQ(info->shape.cells, 32);
  EXPECT_EQ(info->world_hash, protocol::world_hash(Manifest{}));
}

TEST(WorldInfo, RefusesWhatNoWorldHas) {
  const std::string good = protocol::manifest_json(Manifest{});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return parse_world_info(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_TRUE(with("\"voxel_m\":1", "\"voxel_m\":2"));
  EXPECT_FALSE(with("\"voxel_m\":1", "\"voxel_m\":0"));
  EXPECT_FALSE(with("\"voxel_m\":1", "\"voxel_m\":-1"));
  EXPECT_FALSE(with("\"voxel_m\":1", "\"voxel_m\":\"1\""));
  EXPECT_FALSE(with("\"chunk_cells\":32", "\"chunk_cells\":1000000"));
  EXPECT_FALSE(with("\"chunk_cells\":32", "\"chunk_cell\":32"));
  EXPECT_FALSE(with("\"lod_max\":12", "\"lod_max\":99"));
  EXPECT_FALSE(with("\"height_range_m\":[", "\"height_range_m\":[1e99,"));
  for (const char* bad : {"", "[]", "{}", "null", "{\"name\":", "\xFF"}) EXPECT_FALSE(parse_world_info(bad)) << bad;
}

TEST(WorldInfo, GivesTheWorldItselfToEvaluate) {
  Manifest manifest;
  manifest.name = "other";
  manifest.seed = 18446744073709551615U;
  manifest.values[parameter_index("erosion.octaves")] = 3;
  const auto info = parse_world_info(protocol::manifest_json(manifest));
  ASSERT_TRUE(info);
  EXPECT_EQ(manifest_of(*info), manifest);
  WorldInfo newer = *info;
  newer.world_hash.front() = newer.world_hash.front() == '0' ? '1' : '0';
  EXPECT_FALSE(manifest_of(newer));
}

TEST(Heights, AreAllThereOrNone) {
  EXPECT_EQ(parse_heights(R"({"points":[{"height_m":1.5},{"height_m":-2}]})"), (std::vector<double>{1.5, -2}));
  for (const char* bad : {"", "[]", "{}", R"({"points":[{"height_m":1},{}]})", R"({"points":3})"}) {
    EXPECT_TRUE(parse_heights(bad).empty()) << bad;
  }
}

TEST(Spawn, IsAPlaceOrNothing) {
  EXPECT_EQ(parse_spawn(R"({"x":1.5,"y":-2,"z":3e9})"), (glm::dvec3{1.5, -2, 3e9}));
  for (const char* bad : {"", "{}", R"({"x":1,"y":2})", R"({"x":"1","y":2,"z":3})", "[1,2,3]"})
    EXPECT_FALSE(parse_spawn(bad));
}

}  // namespace
}  // namespace talus::client
