// A server's own counters between two readings of its /metrics. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace talus::load {

/// One reading: every sample of the text by its name with labels, as "talus_chunks_sent_total".
using MetricSamples = std::map<std::string, double>;
/// Prometheus' text format 0.0.4; lines that are none are skipped.
MetricSamples parse_metrics(std::string_view text);

struct HopFigures {
  std::uint64_t count = 0;
  double mean_s = 0;
  double p50_s = 0;  ///< upper limits of the histogram's buckets
  double p99_s = 0;
};

struct ServerFigures {
  std::map<std::string, double> counters;  ///< what each has grown by; those that did not are left out
  std::map<std::string, HopFigures> hops;  ///< of those passed at least once
};
ServerFigures figures_between(const MetricSamples& before, const MetricSamples& after);

}  // namespace talus::load
