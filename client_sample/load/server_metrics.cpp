#include "client_sample/load/server_metrics.hpp"

#include <charconv>
#include <limits>
#include <utility>
#include <vector>

namespace talus::load {
namespace {

constexpr std::string_view kHopBucket = "talus_hop_seconds_bucket{";
constexpr std::string_view kHopSum = "talus_hop_seconds_sum{";

/// The value of a label in `name{a="x",b="y"}`.
std::string_view label(std::string_view sample, std::string_view name) {
  const std::string begin = std::string(name) + "=\"";
  const std::size_t at = sample.find(begin);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = sample.substr(at + begin.size());
  return rest.substr(0, rest.find('"'));
}

double number(std::string_view text) {
  if (text == "+Inf") return std::numeric_limits<double>::infinity();
  double out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

double grown(const MetricSamples& before, const std::string& name, double now) {
  const auto found = before.find(name);
  return found == before.end() ? now : now - found->second;
}

/// `buckets` by upper limit, cumulative.
double quantile(const std::map<double, double>& buckets, double q) {
  const double total = buckets.rbegin()->second;
  double last = 0;
  for (const auto& [limit_s, count] : buckets) {
    if (limit_s != std::numeric_limits<double>::infinity()) last = limit_s;
    if (count >= q * total) return last;
  }
  return last;
}

}  // namespace

MetricSamples parse_metrics(std::string_view text) {
  MetricSamples out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t blank = line.rfind(' ');
    if (line.starts_with('#') || blank == std::string_view::npos || blank == 0) continue;
    out[std::string(line.substr(0, blank))] = number(line.substr(blank + 1));
  }
  return out;
}

ServerFigures figures_between(const MetricSamples& before, const MetricSamples& after) {
  ServerFigures out;
  std::map<std::string, std::map<double, double>> buckets;
  std::map<std::string, double> sums;
  for (const auto& [name, value] : after) {
    const double by = grown(before, name, value);
    if (name.starts_with(kHopBucket)) {
      buckets[std::string(label(name, "hop"))][number(label(name, "le"))] = by;
    } else if (name.starts_with(kHopSum)) {
      sums[std::string(label(name, "hop"))] = by;
    } else if (name.substr(0, name.find('{')).ends_with("_total") && by > 0) {
      out.counters[name] = by;
    }
  }
  for (const auto& [hop, counts] : buckets) {
    const double count = counts.rbegin()->second;
    if (count <= 0) continue;
    out.hops[hop] = {static_cast<std::uint64_t>(count), sums[hop] / count, quantile(counts, 0.5),
                     quantile(counts, 0.99)};
  }
  return out;
}

}  // namespace talus::load
