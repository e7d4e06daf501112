#include "client_sample/load/report.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace talus::load {
namespace {

constexpr std::array<std::string_view, kMeasures> kMeasureNames{
    "welcome", "first_chunk", "ground", "complete", "resume", "chunk", "cut", "first_byte", "first_byte_again"};
constexpr std::array<std::string_view, kTallies> kTallyNames{
    "looks", "chunks", "surfaces", "strips", "leaves", "bytes", "asked", "answered", "refused", "broken", "reconnects"};
constexpr std::size_t kEndsListed = 32;

/// Sentences of servers go into JSON: quotes, backslashes and control characters must not break it.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

template <typename Entries, typename Print>
std::string joined(const Entries& entries, Print print) {
  std::string out;
  for (const auto& entry : entries) {
    if (!out.empty()) out += ',';
    out += print(entry);
  }
  return out;
}

std::string json_of(const Histogram& times) {
  return fmt::format(R"({{"count":{},"mean_s":{:.6f},"p50_s":{:.6f},"p90_s":{:.6f},"p99_s":{:.6f},"max_s":{:.6f}}})",
                     times.count(), times.mean_s(), times.quantile_s(0.5), times.quantile_s(0.9),
                     times.quantile_s(0.99), times.max_s());
}

std::string json_of(const KindReport& kind, std::string_view name, int bots) {
  std::string out = fmt::format(R"({}:{{"bots":{})", quoted(name), bots);
  for (std::size_t i = 0; i < kTallies; ++i) out += fmt::format(R"(,"{}":{})", kTallyNames[i], kind.counts[i]);
  for (std::size_t i = 0; i < kMeasures; ++i) {
    if (kind.times[i].count() > 0) out += fmt::format(R"(,"{}":{})", kMeasureNames[i], json_of(kind.times[i]));
  }
  return out + '}';
}

}  // namespace

std::string_view name_of(Measure measure) {
  return kMeasureNames[static_cast<std::size_t>(measure)];
}
std::string_view name_of(Tally tally) {
  return kTallyNames[static_cast<std::size_t>(tally)];
}

void KindReport::record(Measure measure, double took_s) {
  const auto took = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(took_s));
  times[static_cast<std::size_t>(measure)].record(took);
}

void Report::fault(std::string what) {
  ++faults;
  if (first_faults.size() < kFaultsListed) first_faults.push_back(std::move(what));
}

void Report::ended(const std::string& why) {
  if (ends.size() < kEndsListed || ends.contains(why)) ++ends[why];
}

std::uint64_t Report::total(Tally tally) const {
  std::uint64_t out = 0;
  for (const KindReport& kind : kinds) out += kind.value(tally);
  return out;
}

std::string json_of(const Report& report, const Scenario& scenario) {
  std::string kinds;
  for (std::size_t i = 0; i < kBotKinds; ++i) {
    if (scenario.groups[i].count == 0) continue;
    if (!kinds.empty()) kinds += ',';
    kinds += json_of(report.kinds[i], name_of(static_cast<BotKind>(i)), scenario.groups[i].count);
  }
  const auto ends = joined(report.ends, [](const auto& e) { return fmt::format("{}:{}", quoted(e.first), e.second); });
  const auto counters =
      joined(report.server.counters, [](const auto& e) { return fmt::format("{}:{:.0f}", quoted(e.first), e.second); });
  const auto hops = joined(report.server.hops, [](const auto& e) {
    return fmt::format(R"({}:{{"count":{},"mean_s":{:.6f},"p50_s":{:.6f},"p99_s":{:.6f}}})", quoted(e.first),
                       e.second.count, e.second.mean_s, e.second.p50_s, e.second.p99_s);
  });
  return fmt::format(
      R"({{"seconds":{:.3f},"bots":{},"chunks_per_s":{:.1f},"bytes_per_s":{:.0f},"faults":{},"first_faults":[{}],)"
      R"("payloads_compared":{},"kinds":{{{}}},"ends":{{{}}},"server":{{"counters":{{{}}},"hops":{{{}}}}}}})",
      report.seconds, scenario.bots(), static_cast<double>(report.total(Tally::kChunks)) / report.seconds,
      static_cast<double>(report.total(Tally::kBytes)) / report.seconds, report.faults,
      joined(report.first_faults, [](const std::string& text) { return quoted(text); }), report.compared, kinds, ends,
      counters, hops);
}

std::string table_of(const Report& report, const Scenario& scenario) {
  std::string out = fmt::format("{} bots, {:.1f} s: {:.0f} chunks/s, {:.2f} MB/s\n", scenario.bots(), report.seconds,
                                static_cast<double>(report.total(Tally::kChunks)) / report.seconds,
                                static_cast<double>(report.total(Tally::kBytes)) / report.seconds / 1e6);
  out += fmt::format("\n{:<28}{:>9}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "count", "mean ms", "p50 ms", "p90 ms",
                     "p99 ms", "max ms");
  const auto row = [&](std::string_view name, const Histogram& t) {
    out += fmt::format("{:<28}{:>9}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}\n", name, t.count(), t.mean_s() * 1e3,
                       t.quantile_s(0.5) * 1e3, t.quantile_s(0.9) * 1e3, t.quantile_s(0.99) * 1e3, t.max_s() * 1e3);
  };
  for (std::size_t kind = 0; kind < kBotKinds; ++kind) {
    if (scenario.groups[kind].count == 0) continue;
    for (std::size_t i = 0; i < kMeasures; ++i) {
      const Histogram& times = report.kinds[kind].times[i];
      if (times.count() > 0) row(fmt::format("{} {}", name_of(static_cast<BotKind>(kind)), kMeasureNames[i]), times);
    }
  }
  for (const auto& [hop, figures] : report.server.hops) {
    out += fmt::format("{:<28}{:>9}{:>10.3f}{:>10.3f}{:>10}{:>10.3f}\n", "server " + hop, figures.count,
                       figures.mean_s * 1e3, figures.p50_s * 1e3, "", figures.p99_s * 1e3);
  }
  out += '\n';
  for (std::size_t kind = 0; kind < kBotKinds; ++kind) {
    if (scenario.groups[kind].count == 0) continue;
    out += fmt::format("{} x{}:", name_of(static_cast<BotKind>(kind)), scenario.groups[kind].count);
    for (std::size_t i = 0; i < kTallies; ++i) {
      if (report.kinds[kind].counts[i] > 0) out += fmt::format(" {} {}", kTallyNames[i], report.kinds[kind].counts[i]);
    }
    out += '\n';
  }
  for (const auto& [name, value] : report.server.counters) out += fmt::format("server {} +{:.0f}\n", name, value);
  for (const auto& [why, times] : report.ends) out += fmt::format("ended {} times: {}\n", times, why);
  out += fmt::format("\n{} payloads compared with the world function here, {} faults in all\n", report.compared,
                     report.faults);
  for (const std::string& text : report.first_faults) out += "fault: " + text + '\n';
  return out;
}

}  // namespace talus::load
