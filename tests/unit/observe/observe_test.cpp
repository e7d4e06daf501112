#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "server/observe/json.hpp"
#include "server/observe/log.hpp"
#include "server/observe/metrics.hpp"
#include "server/observe/process_readings.hpp"

namespace talus::server {
namespace {

using std::chrono::microseconds;

TEST(JsonString, EscapesWhatWouldBreakOutOfItsQuotes) {
  EXPECT_EQ(json_string("a\"b\\c"), R"("a\"b\\c")");
  EXPECT_EQ(json_string(std::string("\n\0\x1f\x7f", 4)), R"("\u000a\u0000\u001f\u007f")");
}

TEST(JsonString, KeepsUtf8AndReplacesWhatIsNot) {
  EXPECT_EQ(json_string("１é𝄞"), "\"１é𝄞\"");
  EXPECT_EQ(json_string("a\xff"
                        "b\xc3"),
            R"("a\ufffdb\ufffd")");
  EXPECT_EQ(json_string("\xed\xa0\x80"), R"("\ufffd\ufffd\ufffd")") << "a surrogate half";
  EXPECT_EQ(json_string("\xc0\xaf"), R"("\ufffd\ufffd")") << "an overlong slash";
}

TEST(LatencyHistogram, CountsInTheBucketWhoseBoundIsTheFirstNotBelow) {
  LatencyHistogram histogram;
  histogram.record(microseconds(1));
  histogram.record(microseconds(2));
  histogram.record(microseconds(3));
  histogram.record(std::chrono::hours(1));
  histogram.record(microseconds(-5));
  EXPECT_EQ(histogram.count(0), 2U);
  EXPECT_EQ(histogram.count(1), 1U);
  EXPECT_EQ(histogram.count(2), 1U);
  EXPECT_EQ(histogram.count(kLatencyBuckets - 1), 1U);
}

TEST(Metrics, WritesEveryCounterHopAndReadingAsPrometheusReadsThem) {
  Metrics metrics;
  metrics.add(Count::kChunkHit, 3);
  metrics.record(Hop::kBuildChunk, microseconds(700));
  metrics.watch({"talus_answer", "What it is", {}, {}, false}, [] { return 42.0; });
  metrics.watch({"talus_asked_total", "How often", "by", "mice", true}, [] { return 3.0; });
  metrics.watch({"talus_asked_total", "How often", "by", "men", true}, [] { return 4.0; });
  const std::string text = metrics.text();
  EXPECT_NE(text.find("talus_chunk_requests_total{outcome=\"hit\"} 3"), std::string::npos);
  EXPECT_NE(text.find("talus_hop_seconds_count{hop=\"build_chunk\"} 1"), std::string::npos);
  EXPECT_NE(text.find("talus_hop_seconds_bucket{hop=\"build_chunk\",le=\"+Inf\"} 1"), std::string::npos);
  EXPECT_NE(text.find("# TYPE talus_answer gauge\ntalus_answer 42"), std::string::npos);
  const std::string asked =
      "# TYPE talus_asked_total counter\ntalus_asked_total{by=\"mice\"} 3\ntalus_asked_total{by=\"men\"} 4";
  EXPECT_NE(text.find(asked), std::string::npos) << "one family, both of its readings";
  EXPECT_EQ(text.find("_total{} "), std::string::npos);
}

TEST(Metrics, AddUpWhatThreadsHaveCountedThatGoOnOrAreGone) {
  Metrics metrics;
  Metrics others;
  constexpr int kThreads = 4;
  constexpr std::uint64_t kTimes = 10'000;
  for (int round = 0; round < 2; ++round) {
    std::vector<std::jthread> threads;
    for (int i = 0; i < kThreads; ++i) {
      threads.emplace_back([&] {
        for (std::uint64_t n = 0; n < kTimes; ++n) {
          metrics.add(Count::kChunkHit);
          metrics.record(Hop::kLoad, microseconds(1));
          if (n % 100 == 0) others.add(Count::kChunkHit, 2);
        }
      });
    }
    while (metrics.value(Count::kChunkHit) == 0) std::this_thread::yield();
  }
  EXPECT_EQ(metrics.value(Count::kChunkHit), 2 * kThreads * kTimes);
  EXPECT_EQ(others.value(Count::kChunkHit), 2 * kThreads * kTimes / 50);
  const std::string count = "talus_hop_seconds_count{hop=\"load\"} " + std::to_string(2 * kThreads * kTimes) + "\n";
  EXPECT_NE(metrics.text().find(count), std::string::npos);
}

TEST(ProcessReadings, SayWhatTheProcessTakes) {
  Metrics metrics;
  watch_process(metrics, 1'700'000'000);
  const std::string text = metrics.text();
  const auto value = [&](const std::string& name) {
    const std::size_t at = text.find("\n" + name + " ");
    return at == std::string::npos ? -1.0 : std::stod(text.substr(at + name.size() + 2));
  };
  EXPECT_EQ(value("process_start_time_seconds"), 1'700'000'000.0);
  EXPECT_GT(value("process_resident_memory_bytes"), 1e6);
  EXPECT_GE(value("process_open_fds"), 3.0);
  EXPECT_GT(value("process_max_fds"), value("process_open_fds"));
  EXPECT_GE(value("process_cpu_seconds_total"), 0.0);
}

TEST(Log, KnowsItsLevelsByName) {
  EXPECT_EQ(log_level("warning"), LogLevel::kWarning);
  EXPECT_FALSE(log_level("loud"));
}

TEST(Log, WritesOneJsonObjectALineAndNothingBelowItsLevel) {
  testing::internal::CaptureStderr();
  set_log_level(LogLevel::kWarning);
  log(LogLevel::kInfo, "unseen");
  log(LogLevel::kError, "seen", {{"text", "a\"\n"}, {"whole", std::int64_t{-3}}, {"flag", true}, {"nan", 0.0 / 0.0}});
  const std::string out = testing::internal::GetCapturedStderr();
  EXPECT_EQ(out.find("unseen"), std::string::npos);
  EXPECT_NE(out.find(R"("level":"error","event":"seen","text":"a\"\u000a","whole":-3,"flag":true,"nan":null})"),
            std::string::npos)
      << out;
  EXPECT_EQ(out.find('\n'), out.size() - 1);
}

}  // namespace
}  // namespace talus::server
