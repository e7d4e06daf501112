// TLS on every listener, with certificates made here: who trusts them is served, who does not is not.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "client_sample/library/http_get.hpp"
#include "client_sample/library/world_stream.hpp"
#include "tests/sim/peer.hpp"
#include "tests/sim/running_server.hpp"
#include "tests/support/certificate.hpp"

namespace talus::server {
namespace {

test::CertificateFiles certificate(const std::string& name) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return test::make_certificate(testing::TempDir() + "tls_sim_" + test->name() + "_" + name);
}

Settings secure_settings(const test::CertificateFiles& files) {
  Settings settings = quiet_settings();
  settings.tls_certificate = files.certificate;
  settings.tls_key = files.key;
  return settings;
}

client::ServerAddress reach(const std::string& scheme, const std::string& bound, const std::string& ca_file) {
  auto address = *client::parse_server_url(scheme + bound);
  address.ca_file = ca_file;
  return address;
}

/// What became of one look at a small place: an error, or nothing when the view was complete.
std::optional<client::ClientError> look_around(const client::ServerAddress& server) {
  client::Loop loop;
  client::StreamOptions options;
  options.server = server;
  bool is_complete = false;
  std::uint64_t bytes = 0;
  std::optional<client::ClientError> closed;
  client::StreamHandlers handlers;
  handlers.on_chunk = [&](const client::ArrivedChunk& chunk) { bytes += chunk.message_bytes; };
  handlers.on_idle = [&](const protocol::Idle& idle) { is_complete = idle.view_sequence == 1; };
  handlers.on_closed = [&](const client::ClientError& error) { closed = error; };
  client::WorldStream stream(loop, options, handlers);
  protocol::View view;
  view.position = {0, 600, 0};
  view.far_m = 300;
  stream.look(view);
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!is_complete && !closed && std::chrono::steady_clock::now() < until)
    loop.run_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(is_complete || closed) << "nothing came of it in a minute";
  if (is_complete) {
    EXPECT_GT(bytes, 0U);
  }
  return closed;
}

TEST(TlsSim, ServesHttpsToWhoTrustsTheCertificateAndToNobodyElse) {
  const auto files = certificate("a");
  RunningServer server(secure_settings(files));
  const auto trusting = client::http_get(reach("https://", server->http_address(), files.certificate), "/healthz");
  ASSERT_TRUE(trusting.has_value()) << trusting.error().message;
  EXPECT_EQ(trusting->body, "ok\n");
  const auto doubting = client::http_get(reach("https://", server->http_address(), ""), "/healthz");
  ASSERT_FALSE(doubting.has_value());
  EXPECT_NE(doubting.error().message.find("certificate verify failed"), std::string::npos) << doubting.error().message;
  EXPECT_EQ(get(server->admin_address(), "/healthz").status, 200) << "the admin door is not in tls_on";
  EXPECT_TRUE(eventually([&] { return server.count(Count::kTlsEstablished) == 1; }));
  EXPECT_TRUE(eventually([&] { return server.count(Count::kTlsFailed) == 1; }));
}

TEST(TlsSim, ACertificateOfAnotherNameIsNotTaken) {
  const auto files = certificate("a");
  Settings settings = secure_settings(files);
  settings.listen = "127.0.0.2:0";
  RunningServer server(settings);
  const auto answer = client::http_get(reach("https://", server->http_address(), files.certificate), "/healthz");
  ASSERT_FALSE(answer.has_value());
  EXPECT_NE(answer.error().message.find("certificate verify failed"), std::string::npos) << answer.error().message;
}

TEST(TlsSim, AnswersALargeBodyWholeAndByteForByte) {
  const auto files = certificate("a");
  RunningServer secure(secure_settings(files));
  RunningServer plain;
  const std::string target = "/v1/worlds/default/map/3/0/0.png";
  const auto sealed = client::http_get(reach("https://", secure->http_address(), files.certificate), target);
  ASSERT_TRUE(sealed.has_value()) << sealed.error().message;
  EXPECT_GT(sealed->body.size(), 20'000U) << "more than one TLS record";
  EXPECT_EQ(sealed->body, get(plain->http_address(), target).body);
}

TEST(TlsSim, StreamsAViewOverWssAndOverTlsAlone) {
  const auto files = certificate("a");
  RunningServer server(secure_settings(files));
  const auto over_wss = look_around(reach("wss://", server->http_address(), files.certificate));
  EXPECT_FALSE(over_wss) << over_wss->message;
  const auto over_tls = look_around(reach("tls://", server->tcp_address(), files.certificate));
  EXPECT_FALSE(over_tls) << over_tls->message;
  EXPECT_TRUE(look_around(reach("tls://", server->tcp_address(), "")).has_value());
}

TEST(TlsSim, EndsWhoSpeaksInClearOrSaysNothing) {
  Settings settings = secure_settings(certificate("a"));
  settings.limits.silent_s = 0.3;
  RunningServer server(settings);
  Peer clear(server->http_address());
  clear.wait_at_most(30);
  clear.send(get_request("/healthz"));
  EXPECT_TRUE(clear.is_ended_by_other());
  Peer silent(server->http_address());
  silent.wait_at_most(30);
  EXPECT_TRUE(silent.is_ended_by_other());
  EXPECT_TRUE(eventually([&] { return server.count(Count::kTlsFailed) == 2; })) << "the silent one's failed as well";
  EXPECT_EQ(server.count(Count::kSilentTimeout), 1U);
}

TEST(TlsSim, TakesANewCertificateWhileItRunsAndKeepsTheOldOneOverABadOne) {
  const auto old_files = certificate("old");
  const auto new_files = certificate("new");
  Settings settings = secure_settings(old_files);
  RunningServer server(settings);
  const auto is_served = [&](const std::string& ca_file) {
    return client::http_get(reach("https://", server->http_address(), ca_file), "/healthz").has_value();
  };
  EXPECT_TRUE(is_served(old_files.certificate));

  settings.tls_key = new_files.key;
  const auto mixed = server->reload(settings);
  ASSERT_FALSE(mixed.has_value());
  EXPECT_NE(mixed.error().find(new_files.key), std::string::npos) << mixed.error();
  EXPECT_TRUE(is_served(old_files.certificate));
  EXPECT_EQ(server.count(Count::kReloadsRefused), 1U);

  settings.tls_certificate = new_files.certificate;
  ASSERT_TRUE(server->reload(settings).has_value());
  EXPECT_TRUE(is_served(new_files.certificate));
  EXPECT_FALSE(is_served(old_files.certificate));
  EXPECT_EQ(server.count(Count::kReloads), 1U);
}

TEST(TlsSim, AServerDoesNotStartWithFilesItCannotUse) {
  const auto files = certificate("a");
  Settings settings = secure_settings(files);
  settings.tls_certificate = files.key;
  const auto without_certificate = Server::start(settings);
  ASSERT_FALSE(without_certificate.has_value());
  EXPECT_NE(without_certificate.error().find("no certificate in PEM"), std::string::npos);
  settings = secure_settings(files);
  settings.tls_key = "/no/such/key";
  const auto without_key = Server::start(settings);
  ASSERT_FALSE(without_key.has_value());
  EXPECT_NE(without_key.error().find("/no/such/key"), std::string::npos);
}

}  // namespace
}  // namespace talus::server
