// The load tester against a whole server: some of every kind find nothing wrong.
#include <gtest/gtest.h>

#include <algorithm>

#include "client_sample/load/run.hpp"
#include "tests/sim/running_server.hpp"

namespace talus::server {
namespace {

TEST(Load, SomeOfEveryKindFindNothingWrong) {
  RunningServer server;
  load::Scenario scenario;
  scenario.seconds = 120;  // at most: it ends when everybody has got something
  scenario.samples = 6;
  for (std::size_t i = 0; i < load::kBotKinds; ++i) {
    load::Group& group = scenario.groups[i];
    group.count = 1;
    group.far_m = 250;
    group.spread_m = 1000;
    group.every_s = 0.5;
    group.carrier = i % 2 == 0 ? client::Carrier::kTcp : client::Carrier::kWebSocket;
  }
  load::RunOptions options;
  options.http = *client::parse_server_url("http://" + server->http_address());
  options.tcp = *client::parse_server_url("tcp://" + server->tcp_address());
  options.admin = *client::parse_server_url("http://" + server->admin_address());
  options.is_over = [](const load::Report& report) {
    return report.of(load::BotKind::kReconnect).value(load::Tally::kReconnects) > 0 &&
           std::ranges::all_of(report.kinds, [](const auto& kind) { return kind.value(load::Tally::kChunks) > 0; });
  };
  const auto report = load::run(scenario, options);
  ASSERT_TRUE(report) << report.error();
  EXPECT_EQ(report->faults, 0U) << report->first_faults.front();
  EXPECT_EQ(report->compared, 6U);
  EXPECT_EQ(report->total(load::Tally::kBroken), 0U) << report->ends.begin()->first;
  for (std::size_t i = 0; i < load::kBotKinds; ++i) {
    EXPECT_GT(report->kinds[i].value(load::Tally::kChunks), 0U) << name_of(static_cast<load::BotKind>(i));
  }
  EXPECT_GT(report->server.counters.at("talus_chunks_sent_total"), 0.0);
}

TEST(Load, SaysThatThereIsNoServer) {
  load::Scenario scenario;
  scenario.group(load::BotKind::kFly).count = 1;
  load::RunOptions options;
  options.http = *client::parse_server_url("http://127.0.0.1:1");
  const auto report = load::run(scenario, options);
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().find("no connection"), std::string::npos);
}

}  // namespace
}  // namespace talus::server
