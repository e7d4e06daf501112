#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "client_sample/load/bot.hpp"
#include "client_sample/load/histogram.hpp"
#include "client_sample/load/ledger.hpp"
#include "client_sample/load/report.hpp"
#include "client_sample/load/samples.hpp"
#include "client_sample/load/scenario.hpp"
#include "client_sample/load/server_metrics.hpp"
#include "core/mesh/build_chunk.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::load {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Histogram, IsWithinOneInOneHundredAndTwentyEightOfEveryQuantile) {
  std::mt19937_64 random(7);
  std::vector<double> all;
  Histogram histogram;
  for (int i = 0; i < 20'000; ++i) {
    const auto us = static_cast<std::int64_t>(std::exp(std::uniform_real_distribution(0.0, 20.0)(random)));
    all.push_back(static_cast<double>(us) * 1e-6);
    histogram.record(std::chrono::microseconds(us));
  }
  std::ranges::sort(all);
  for (const double q : {0.001, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double right = all[static_cast<std::size_t>(std::ceil(q * static_cast<double>(all.size()))) - 1];
    EXPECT_NEAR(histogram.quantile_s(q), right, right / 128 + 1e-9) << q;
  }
  EXPECT_DOUBLE_EQ(histogram.max_s(), all.back());
}

TEST(Histogram, AddsUpAndHoldsWhatIsOutOfRange) {
  Histogram a;
  EXPECT_EQ(a.quantile_s(0.5), 0.0);
  a.record(std::chrono::nanoseconds(-5));
  a.record(std::chrono::hours(24 * 365 * 100));
  Histogram b;
  b.record(std::chrono::milliseconds(1));
  a.add(b);
  EXPECT_EQ(a.count(), 3U);
  EXPECT_NEAR(a.quantile_s(0.5), 1e-3, 1e-5);
}

protocol::ChunkHead air(const ChunkKey& key) {
  return {key, 0, ChunkKind::kAir, 0};
}

class LedgerTest : public testing::Test {
 protected:
  LedgerTest() {
    protocol::View view;
    view.position = {0, 100, 0};
    view.far_m = 100;
    accepted.view = protocol::clamped(view, shape);
    protocol::interest_area(accepted.view, shape, area);
    accepted.chunks = static_cast<std::uint32_t>(area.size());
    accepted.sequence = 1;
    ledger.looked(1, 10.0);
    ledger.accepted(accepted);
  }
  protocol::WorldShape shape;
  protocol::ViewAccepted accepted;
  std::vector<ChunkKey> area;
  Ledger ledger{shape};
};

TEST_F(LedgerTest, FindsNothingWrongWithAViewThatComesOnce) {
  for (const ChunkKey& key : area) EXPECT_EQ(ledger.came(air(key), 12.5), 2.5) << "since it was looked for";
  ledger.complete({1, area.size()});
  EXPECT_THAT(ledger.take_faults(), IsEmpty());
  EXPECT_EQ(ledger.held().size(), area.size());
}

TEST_F(LedgerTest, MissesWhatDidNotCome) {
  for (std::size_t i = 1; i < area.size(); ++i) ledger.came(air(area[i]), 11);
  ledger.complete({1, area.size()});
  EXPECT_THAT(ledger.take_faults(), ElementsAre(HasSubstr("never came")));
}

TEST_F(LedgerTest, TakesARefusalForAnAnswerOnce) {
  for (std::size_t i = 1; i < area.size(); ++i) ledger.came(air(area[i]), 11);
  ledger.refused(area[0]);
  ledger.complete({1, area.size()});
  EXPECT_THAT(ledger.take_faults(), IsEmpty());
  ledger.refused(area[0]);
  EXPECT_THAT(ledger.take_faults(), ElementsAre(HasSubstr("refused a second time")));
  ledger.came(air(area[0]), 12);
  EXPECT_THAT(ledger.take_faults(), ElementsAre(HasSubstr("though it had been refused")));
  ledger.refused(area[1]);
  EXPECT_THAT(ledger.take_faults(), ElementsAre(HasSubstr("refused after it had come")));
}

TEST_F(LedgerTest, LetsARefusedChunkBeAskedForAgainOnceItIsLeft) {
  ledger.refused(area[0]);
  ledger.left({area[0]});
  ledger.came(air(area[0]), 12);
  EXPECT_THAT(ledger.take_faults(), IsEmpty());
}

TEST_F(LedgerTest, SeesWhatComesTwiceOrStaysTooLong) {
  for (const ChunkKey& key : area) ledger.came(air(key), 11);
  ledger.came(air(area[0]), 11);
  EXPECT_THAT(ledger.take_faults(), ElementsAre(HasSubstr("a second time")));
  EXPECT_FALSE(ledger.came(air({3, 99, 0, 99}), 11)) << "was not asked for";
  ledger.complete({1, area.size()});
  EXPECT_THAT(ledger.take_faults(), ElementsAre(HasSubstr("was not left")));
  ledger.left({{3, 99, 0, 99}});
  ledger.complete({1, area.size()});
  EXPECT_THAT(ledger.take_faults(), IsEmpty());
  ledger.left({{3, 99, 0, 99}});
  EXPECT_THAT(ledger.take_faults(), ElementsAre(HasSubstr("without having come")));
}

TEST_F(LedgerTest, DoesNotJudgeAViewThatIsNoLongerTheLatest) {
  ledger.looked(2, 11);
  ledger.complete({1, 0});
  EXPECT_THAT(ledger.take_faults(), IsEmpty());
}

TEST_F(LedgerTest, CountsTheServersChunksAgain) {
  accepted.sequence = 2;
  accepted.chunks += 1;
  ledger.looked(2, 11);
  ledger.accepted(accepted);
  EXPECT_THAT(ledger.take_faults(), ElementsAre(HasSubstr("counts")));
}

TEST(Samples, TellWhatTheWorldFunctionDoesNotGive) {
  const Manifest manifest;
  const WorldFunction world(manifest);
  ChunkScratch scratch;
  ChunkMesh mesh;
  Samples good(8, 1);
  Samples bad(8, 1);
  for (std::int32_t y = -4; y <= 4; ++y) {
    const ChunkKey key{8, 0, y, 0};
    const ChunkKind kind = build_chunk(world, key, scratch, mesh);
    std::vector<std::byte> payload;
    if (kind == ChunkKind::kMesh) {
      payload = *protocol::encode_draco(mesh, protocol::mesh_lattice(key, world.cells(), world.voxel_m()));
    }
    good.offer(key, kind, payload);
    if (kind != ChunkKind::kMesh) continue;
    payload.back() ^= std::byte{1};
    bad.offer(key, kind, payload);
    bad.offer(key, ChunkKind::kAir, {});
  }
  EXPECT_THAT(good.compare(manifest), IsEmpty());
  ASSERT_GE(bad.size(), 2U);
  EXPECT_EQ(bad.compare(manifest).size(), bad.size());
}

TEST(Samples, AreAnEvenSampleOfAllThatCame) {
  std::array<int, 4> quarters{};
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Samples samples(1, seed);
    for (int i = 0; i < 40; ++i) samples.offer({0, i, 0, 0}, ChunkKind::kAir, {});
    ASSERT_EQ(samples.size(), 1U);
    ++quarters[static_cast<std::size_t>(samples.key(0).x / 10)];
  }
  for (const int count : quarters) EXPECT_NEAR(count, 100, 45);  // 5 standard deviations
}

TEST(ServerMetrics, SayWhatHasGrownAndHowLongHopsTook) {
  const auto text = [](int sent, int low, int all) {
    std::ostringstream out;
    out << "# HELP talus_chunks_sent_total x\n# TYPE talus_chunks_sent_total counter\ntalus_chunks_sent_total " << sent
        << "\ntalus_chunk_requests_total{outcome=\"hit\"} 5\nnonsense\n"
        << "talus_hop_seconds_bucket{hop=\"queue\",le=\"0.001\"} " << low
        << "\ntalus_hop_seconds_bucket{hop=\"queue\",le=\"0.01\"} " << all
        << "\ntalus_hop_seconds_bucket{hop=\"queue\",le=\"+Inf\"} " << all << "\ntalus_hop_seconds_sum{hop=\"queue\"} "
        << all * 0.002 << "\n";
    return out.str();
  };
  const ServerFigures figures = figures_between(parse_metrics(text(3, 0, 0)), parse_metrics(text(10, 60, 100)));
  EXPECT_THAT(figures.counters, ElementsAre(testing::Pair("talus_chunks_sent_total", 7.0)));
  const HopFigures& queue = figures.hops.at("queue");
  EXPECT_EQ(queue.count, 100U);
  EXPECT_NEAR(queue.mean_s, 0.002, 1e-9);
  EXPECT_EQ(queue.p50_s, 0.001);
  EXPECT_EQ(queue.p99_s, 0.01);
}

TEST(Scenario, IsReadFromItsFile) {
  const auto scenario = parse_scenario("seconds = 12\n[fly]\ncount = 500\nover = \"tcp\"\nfar_m = 1000\n", "a.toml");
  ASSERT_TRUE(scenario);
  EXPECT_EQ(scenario->seconds, 12);
  EXPECT_EQ(scenario->group(BotKind::kFly).count, 500);
  EXPECT_EQ(scenario->group(BotKind::kFly).carrier, client::Carrier::kTcp);
  EXPECT_EQ(scenario->group(BotKind::kFly).far_m, 1000);
  EXPECT_EQ(scenario->bots(), 500);
}

TEST(Scenario, SaysWhereItIsWrong) {
  for (const char* bad :
       {"[fly]\ncount = -1\n", "[fly]\nover = \"pigeon\"\n", "[swim]\ncount = 1\n", "seconds = 0\n"}) {
    const auto scenario = parse_scenario(bad, "a.toml");
    ASSERT_FALSE(scenario) << bad;
    EXPECT_THAT(describe(scenario.error().front()), HasSubstr("a.toml:")) << bad;
  }
}

TEST(Scenario, EveryOneThatComesAlongIsSound) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TALUS_SOURCE_DIR "/client_sample/load/scenarios")) {
    std::ifstream file(entry.path());
    std::stringstream text;
    text << file.rdbuf();
    const auto scenario = parse_scenario(text.str(), entry.path().string());
    ASSERT_TRUE(scenario) << describe(scenario.error().front());
    EXPECT_GT(scenario->bots(), 0) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 4);
}

TEST(Report, IsJsonWhateverServersSay) {
  Scenario scenario;
  scenario.group(BotKind::kFetch).count = 1;
  Report report;
  report.seconds = 2;
  report.ended("they said \"no\\\"\n");
  for (int i = 0; i < 40; ++i) report.fault("fault " + std::to_string(i));
  report.of(BotKind::kFetch).record(Measure::kFirstByte, 0.5);
  const std::string json = json_of(report, scenario);
  EXPECT_THAT(json, HasSubstr(R"("they said \"no\\\"\u000a":1)"));
  EXPECT_THAT(json, HasSubstr(R"("faults":40)"));
  EXPECT_THAT(json, testing::Not(HasSubstr("fault 16")));
  EXPECT_THAT(json, HasSubstr(R"("first_byte":{"count":1)"));
  EXPECT_THAT(table_of(report, scenario), HasSubstr("fetch first_byte"));
}

TEST(Way, GoesThereAndBackAgain) {
  const Way way{{0, 0, 0}, {10, 0, 0}, 2};
  EXPECT_EQ(way.at(2).x, 4);
  EXPECT_EQ(way.at(7).x, 6);
  EXPECT_EQ(way.velocity(2).x, 2);
  EXPECT_EQ(way.velocity(7).x, -2);
  EXPECT_EQ(way.at(10), way.from);
  EXPECT_EQ((Way{{1, 2, 3}, {1, 2, 3}, 5}.at(9)), (glm::dvec3{1, 2, 3}));
}

}  // namespace
}  // namespace talus::load
