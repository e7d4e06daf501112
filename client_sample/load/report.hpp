// What a run has measured: a table of histograms and one of counters for each kind of bot, and what was found wrong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "client_sample/load/histogram.hpp"
#include "client_sample/load/scenario.hpp"
#include "client_sample/load/server_metrics.hpp"

namespace talus::load {

/// Durations, each with a histogram a kind of bot.
enum class Measure : std::uint8_t {
  kWelcome,         ///< from connecting to the server's welcome
  kFirstChunk,      ///< from connecting to the first chunk
  kGround,          ///< from connecting to a surface of LOD 0 below the viewer: one can walk
  kComplete,        ///< from connecting to the first complete view
  kResume,          ///< from connecting again to a complete view
  kChunk,           ///< of verified viewers: from the look that first asks for a chunk to its coming
  kCut,             ///< from the moment a bot stops reading to the end of its connection
  kFirstByte,       ///< from a chunk's first HTTP request to its first byte
  kFirstByteAgain,  ///< the same when this bot has had the chunk before: cached, as a rule
  kEnd
};
inline constexpr std::size_t kMeasures = static_cast<std::size_t>(Measure::kEnd);
std::string_view name_of(Measure measure);

enum class Tally : std::uint8_t {
  kLooks,
  kChunks,  ///< came, surfaces and empties
  kSurfaces,
  kStrips,
  kLeaves,
  kBytes,     ///< of payloads
  kAsked,     ///< HTTP requests, and keys wanted by name
  kAnswered,  ///< of those
  kRefused,   ///< 429, 503, or told on a stream that it cannot be made
  kBroken,    ///< connections that failed under a request, or were ended by the server
  kReconnects,
  kEnd
};
inline constexpr std::size_t kTallies = static_cast<std::size_t>(Tally::kEnd);
std::string_view name_of(Tally tally);

struct KindReport {
  std::array<Histogram, kMeasures> times;
  std::array<std::uint64_t, kTallies> counts{};

  void record(Measure measure, double took_s);
  void count(Tally tally, std::uint64_t by = 1) { counts[static_cast<std::size_t>(tally)] += by; }
  std::uint64_t value(Tally tally) const { return counts[static_cast<std::size_t>(tally)]; }
};

struct Report {
  std::array<KindReport, kBotKinds> kinds;
  double seconds = 0;
  std::uint64_t compared = 0;  ///< payloads that were evaluated here
  std::uint64_t faults = 0;
  std::vector<std::string> first_faults;      ///< sentences, at most kFaultsListed
  std::map<std::string, std::uint64_t> ends;  ///< why connections ended, with how many; bounded
  ServerFigures server;

  static constexpr std::size_t kFaultsListed = 16;
  void fault(std::string what);
  void ended(const std::string& why);
  KindReport& of(BotKind kind) { return kinds[static_cast<std::size_t>(kind)]; }
  const KindReport& of(BotKind kind) const { return kinds[static_cast<std::size_t>(kind)]; }
  std::uint64_t total(Tally tally) const;
};

/// One JSON object in one line.
std::string json_of(const Report& report, const Scenario& scenario);
/// A table for people.
std::string table_of(const Report& report, const Scenario& scenario);

}  // namespace talus::load
