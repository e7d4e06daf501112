#include "client_sample/load/run.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "client_sample/library/fetch_world.hpp"
#include "client_sample/library/http_get.hpp"
#include "client_sample/load/crowd.hpp"

namespace talus::load {
namespace {

constexpr std::chrono::milliseconds kTick{5};
constexpr std::chrono::milliseconds kGoodbye{500};

/// Nothing without an admin address; a server that does not answer there is not worth the run.
MetricSamples metrics_of(const RunOptions& options) {
  if (!options.admin) return {};
  const auto answer = client::http_get(*options.admin, "/metrics");
  return answer && answer->status == 200 ? parse_metrics(answer->body) : MetricSamples{};
}

std::string line_of(const Report& now, std::uint64_t chunks_before, std::uint64_t bytes_before, const Crowd& crowd,
                    double seconds) {
  const auto connected = std::ranges::count_if(crowd, [](const auto& bot) { return bot->is_connected(); });
  return fmt::format("{:6.1f} s  {}/{} connected  {} chunks (+{})  {:.2f} MB/s  {} refused  {} broken  {} faults",
                     seconds, connected, crowd.size(), now.total(Tally::kChunks),
                     now.total(Tally::kChunks) - chunks_before,
                     static_cast<double>(now.total(Tally::kBytes) - bytes_before) / 1e6, now.total(Tally::kRefused),
                     now.total(Tally::kBroken), now.faults);
}

void drive(const Stage& stage, const RunOptions& options, Crowd& crowd) {
  std::uint64_t chunks_before = 0;
  std::uint64_t bytes_before = 0;
  double next_line_s = 1;
  for (;;) {
    const double now_s = stage.now_s();
    if (now_s >= stage.scenario.seconds || (options.is_over && options.is_over(stage.report))) return;
    for (const auto& bot : crowd) bot->tick(now_s);
    if (now_s >= next_line_s && options.on_line) {
      options.on_line(line_of(stage.report, chunks_before, bytes_before, crowd, now_s));
      chunks_before = stage.report.total(Tally::kChunks);
      bytes_before = stage.report.total(Tally::kBytes);
      next_line_s += 1;
    }
    stage.loop.run_for(kTick);
  }
}

/// Every request ended in exactly one way, or is the one that its bot had under way when the time was up.
void check_fetches(Report& report, const Scenario& scenario) {
  const KindReport& fetch = report.of(BotKind::kFetch);
  const std::uint64_t ended =
      fetch.value(Tally::kAnswered) + fetch.value(Tally::kRefused) + fetch.value(Tally::kBroken);
  const std::uint64_t open_max = static_cast<std::uint64_t>(scenario.group(BotKind::kFetch).count);
  const std::uint64_t asked = fetch.value(Tally::kAsked);
  if (ended > asked || asked - ended > open_max) {
    report.fault(fmt::format("fetch: {} requests, {} ends", asked, ended));
  }
}

}  // namespace

std::expected<Report, std::string> run(const Scenario& scenario, const RunOptions& options) {
  auto world = client::fetch_world(options.http, options.world);
  if (!world) return std::unexpected(world.error());
  client::Loop loop;
  Report report;
  Samples samples(static_cast<std::size_t>(scenario.samples), static_cast<std::uint64_t>(scenario.seed));
  Stage stage{loop, options.http, options.tcp, std::move(*world), scenario, report, samples};
  auto crowd = gather(stage);
  if (!crowd) return std::unexpected(crowd.error());

  const MetricSamples before = metrics_of(options);
  stage.began = std::chrono::steady_clock::now();
  drive(stage, options, *crowd);
  report.seconds = stage.now_s();
  report.server = figures_between(before, metrics_of(options));
  for (const auto& bot : *crowd) bot->leave();
  loop.run_for(kGoodbye);
  crowd->clear();

  check_fetches(report, scenario);
  if (samples.size() == 0) return report;
  if (const auto manifest = client::manifest_of(stage.world)) {
    for (std::string& what : samples.compare(*manifest)) report.fault(std::move(what));
    report.compared = samples.size();
  } else if (options.on_line) {
    options.on_line("payloads are not compared: the server's world is of another generator version than this program");
  }
  return report;
}

}  // namespace talus::load
