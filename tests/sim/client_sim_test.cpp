// The client library against a whole server, over every carrier.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "client_sample/library/world_stream.hpp"
#include "client_sample/library/world_viewer.hpp"
#include "tests/sim/running_server.hpp"

namespace talus::server {
namespace {

client::ServerAddress address_of(RunningServer& server, client::Carrier carrier) {
  const bool is_tcp = carrier == client::Carrier::kTcp;
  const std::string& bound = is_tcp ? server->tcp_address() : server->http_address();
  return *client::parse_server_url((is_tcp ? "tcp://" : "http://") + bound);
}

class ClientOver : public testing::TestWithParam<client::Carrier> {
 protected:
  template <typename Done>
  bool run_until(Done done) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!done() && std::chrono::steady_clock::now() < until) loop.run_for(std::chrono::milliseconds(5));
    return done();
  }

  std::optional<RunningServer> server{std::in_place};
  client::Loop loop;
};

INSTANTIATE_TEST_SUITE_P(Carriers, ClientOver, testing::Values(client::Carrier::kWebSocket, client::Carrier::kTcp),
                         [](const auto& of) { return of.param == client::Carrier::kTcp ? "Tcp" : "WebSocket"; });

TEST_P(ClientOver, AViewBecomesCompleteAndIsItsInterestArea) {
  client::StreamOptions options;
  options.server = address_of(*server, GetParam());
  std::vector<ChunkKey> came;
  std::optional<protocol::ViewAccepted> accepted;
  std::optional<client::ClientError> closed;
  bool is_complete = false;
  client::StreamHandlers handlers;
  handlers.on_view = [&](const protocol::ViewAccepted& view) { accepted = view; };
  handlers.on_chunk = [&](const client::ArrivedChunk& chunk) { came.push_back(chunk.head.key); };
  handlers.on_idle = [&](const protocol::Idle& idle) { is_complete = idle.view_sequence == 1; };
  handlers.on_closed = [&](const client::ClientError& error) { closed = error; };
  client::WorldStream stream(loop, options, handlers);
  protocol::View view;
  view.position = {0, 600, 0};
  view.far_m = 300;
  stream.look(view);
  ASSERT_TRUE(run_until([&] { return is_complete || closed; }));
  ASSERT_FALSE(closed) << closed->message;

  std::vector<ChunkKey> area;
  protocol::interest_area(protocol::clamped(view, stream.info()->shape), stream.info()->shape, area);
  std::ranges::sort(area);
  std::ranges::sort(came);
  EXPECT_EQ(came, area);
  EXPECT_EQ(accepted->chunks, area.size());

  stream.close();
  ASSERT_TRUE(run_until([&] { return closed.has_value(); }));
  EXPECT_EQ(closed->message, "closed as asked");
}

TEST_P(ClientOver, AViewerOutlivesItsServerAndIsSentNothingTwice) {
  client::ViewerOptions options;
  options.server = address_of(*server, GetParam());
  options.retry_min = std::chrono::milliseconds(20);
  client::WorldViewer viewer(loop, options);
  protocol::View view;
  view.position = {0, 600, 0};
  view.far_m = 300;
  viewer.look(view);
  std::size_t completes = 0;
  const auto take_all = [&] {
    while (auto event = viewer.next()) completes += std::holds_alternative<client::Complete>(*event) ? 1U : 0U;
  };
  ASSERT_TRUE(run_until([&] { return take_all(), completes == 1; }));
  const std::size_t held = viewer.held();
  ASSERT_GT(held, 20U);

  Settings settings = quiet_settings();
  settings.listen = (*server)->http_address();
  settings.tcp_listen = (*server)->tcp_address();
  server.reset();
  ASSERT_TRUE(run_until([&] { return !viewer.is_connected(); }));
  server.emplace(settings);
  ASSERT_TRUE(run_until([&] { return take_all(), completes == 2; }));
  EXPECT_EQ(server->count(Count::kChunksSent), 0U);
  EXPECT_EQ(viewer.held(), held);
}

TEST_P(ClientOver, AServerThatKnowsNoSuchWorldSaysSo) {
  client::StreamOptions options;
  options.server = address_of(*server, GetParam());
  options.world = "nowhere";
  std::optional<client::ClientError> closed;
  client::StreamHandlers handlers;
  handlers.on_closed = [&](const client::ClientError& error) { closed = error; };
  const client::WorldStream stream(loop, options, handlers);
  ASSERT_TRUE(run_until([&] { return closed.has_value(); }));
  // A WebSocket names its world in the path already.
  EXPECT_EQ(closed->code,
            GetParam() == client::Carrier::kTcp ? client::ErrorCode::kRefused : client::ErrorCode::kHandshake);
}

}  // namespace
}  // namespace talus::server
