// talus load: many clients at once, what they measured, and what they found wrong.
#include <fmt/format.h>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "client_sample/cli/interrupt.hpp"
#include "client_sample/cli/reach_server.hpp"
#include "client_sample/load/run.hpp"

namespace talus::cli {
namespace {

/// One of the server's doors, reached as the options say; what is wrong with the URL has been said.
std::optional<client::ServerAddress> address_of(const LoadOptions& options, const std::string& url) {
  ServerOptions door = options.server;
  door.url = url;
  const auto address = reach_server(door);
  return address ? std::optional(*address) : std::nullopt;
}

std::expected<load::Scenario, ExitCode> scenario_of(const LoadOptions& options) {
  load::Scenario out;
  if (!options.scenario.empty()) {
    const auto text = load_file(options.scenario, protocol::kTomlBytesMax);
    if (!text) return std::unexpected(kFailed);
    const auto parsed = load::parse_scenario(*text, options.scenario);
    if (!parsed) {
      for (const protocol::TextFault& fault : parsed.error()) fmt::print(stderr, "{}\n", protocol::describe(fault));
      return std::unexpected(kUsage);
    }
    out = *parsed;
  }
  for (std::size_t i = 0; i < load::kBotKinds; ++i) {
    if (options.counts[i] >= 0) out.groups[i].count = options.counts[i];
  }
  if (options.seconds > 0) out.seconds = options.seconds;
  if (out.bots() > 0) return out;
  fmt::print(stderr, "talus: nobody comes: give a scenario file, or how many of a kind as --fly 50\n");
  return std::unexpected(kUsage);
}

}  // namespace

ExitCode load(const LoadOptions& options) {
  const auto scenario = scenario_of(options);
  if (!scenario) return scenario.error();
  const auto http = address_of(options, options.server.url);
  const auto tcp = address_of(options, options.tcp);
  if (!http || !tcp) return kUsage;
  load::RunOptions run{*http, *tcp, std::nullopt, options.server.world, nullptr, nullptr};
  if (!options.metrics.empty()) {
    run.admin = address_of(options, options.metrics);
    if (!run.admin) return kUsage;
  }
  catch_interrupt();
  run.is_over = [](const load::Report&) { return is_interrupted(); };
  run.on_line = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };

  const auto report = load::run(*scenario, run);
  if (!report) {
    fmt::print(stderr, "talus: {}\n", report.error());
    return kFailed;
  }
  fmt::print("{}\n", options.is_json ? load::json_of(*report, *scenario) : load::table_of(*report, *scenario));
  return report->faults == 0 && report->total(load::Tally::kBroken) == 0 ? kDone : kIncomplete;
}

}  // namespace talus::cli
