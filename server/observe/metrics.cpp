#include "server/observe/metrics.hpp"

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace talus::server {

namespace {

struct CountInfo {
  const char* family;
  const char* label;  ///< name of the one label, or nullptr
  const char* value;
  const char* help;
};

// In the order of Count; entries of one family stand together.
constexpr std::array<CountInfo, static_cast<std::size_t>(Count::kEnd)> kCounts{{
    {"talus_http_responses_total", "status", "200", "HTTP answers by status"},
    {"talus_http_responses_total", "status", "204", ""},
    {"talus_http_responses_total", "status", "304", ""},
    {"talus_http_responses_total", "status", "4xx", ""},
    {"talus_http_responses_total", "status", "5xx", ""},
    {"talus_http_body_bytes_total", nullptr, nullptr, "Bytes of the bodies of HTTP answers"},
    {"talus_http_chunks_total", "from", "memory", "Chunks asked for over HTTP: there at once, or from the pool"},
    {"talus_http_chunks_total", "from", "pool", ""},
    {"talus_http_limit_total", "limit", "malformed", "Requests or connections ended by a limit of the HTTP door"},
    {"talus_http_limit_total", "limit", "request_line", ""},
    {"talus_http_limit_total", "limit", "head", ""},
    {"talus_http_limit_total", "limit", "body", ""},
    {"talus_http_limit_total", "limit", "head_deadline", ""},
    {"talus_http_limit_total", "limit", "idle", ""},
    {"talus_http_limit_total", "limit", "silent", ""},
    {"talus_http_limit_total", "limit", "write_stalled", ""},
    {"talus_http_limit_total", "limit", "read_rate_min", ""},
    {"talus_http_limit_total", "limit", "requests_per_connection", ""},
    {"talus_connections_accepted_total", nullptr, nullptr, "Connections taken in"},
    {"talus_connections_refused_total", "limit", "connections", "Connections turned away by a limit"},
    {"talus_connections_refused_total", "limit", "connections_per_address", ""},
    {"talus_connections_refused_total", "limit", "descriptors", ""},
    {"talus_connection_faults_total", nullptr, nullptr, "Connections ended by an unexpected fault of ours"},
    {"talus_tls_handshakes_total", "outcome", "established", "TLS handshakes"},
    {"talus_tls_handshakes_total", "outcome", "failed", ""},
    {"talus_tokens_refused_total", "reason", "missing", "Requests and hellos refused for their join token"},
    {"talus_tokens_refused_total", "reason", "bad", ""},
    {"talus_tokens_refused_total", "reason", "expired", ""},
    {"talus_tokens_refused_total", "reason", "not_yet", ""},
    {"talus_tokens_refused_total", "reason", "other_world", ""},
    {"talus_origins_refused_total", nullptr, nullptr, "WebSockets refused for the origin of their page"},
    {"talus_reloads_total", "outcome", "done", "SIGHUPs by what became of them"},
    {"talus_reloads_total", "outcome", "refused", ""},
    {"talus_chunk_requests_total", "outcome", "hit", "Requests for chunks by what became of them"},
    {"talus_chunk_requests_total", "outcome", "built", ""},
    {"talus_chunk_requests_total", "outcome", "stored", ""},
    {"talus_chunk_requests_total", "outcome", "ruled_out", ""},
    {"talus_chunk_requests_total", "outcome", "joined", ""},
    {"talus_chunk_requests_total", "outcome", "shed", ""},
    {"talus_chunk_requests_total", "outcome", "over_share", ""},
    {"talus_chunk_requests_total", "outcome", "displaced", ""},
    {"talus_chunk_requests_total", "outcome", "cancelled", ""},
    {"talus_chunk_requests_total", "outcome", "failed", ""},
    {"talus_chunk_requests_total", "outcome", "hung", ""},
    {"talus_disk_cache_total", "outcome", "hit", "Entries of the disk cache by what became of them"},
    {"talus_disk_cache_total", "outcome", "miss", ""},
    {"talus_disk_cache_total", "outcome", "bad", ""},
    {"talus_disk_cache_total", "outcome", "stored", ""},
    {"talus_disk_cache_total", "outcome", "evicted", ""},
    {"talus_disk_cache_total", "outcome", "shed", ""},
    {"talus_disk_cache_total", "outcome", "fault", ""},
    {"talus_column_memo_total", "outcome", "hit", "Columns that a chunk stands on: remembered, or evaluated"},
    {"talus_column_memo_total", "outcome", "miss", ""},
    {"talus_tile_memo_total", "outcome", "hit",
     "Tiles of ground around a chunk that its thread had not: another's, or evaluated"},
    {"talus_tile_memo_total", "outcome", "miss", ""},
    {"talus_height_memo_total", "outcome", "hit", "Squares of ground whose heights were asked for: known or not"},
    {"talus_height_memo_total", "outcome", "miss", ""},
    {"talus_queries_shed_total", nullptr, nullptr, "Queries of places refused because the pool was full"},
    {"talus_sessions_opened_total", nullptr, nullptr, "Streaming sessions welcomed"},
    {"talus_sessions_refused_total", nullptr, nullptr, "Hellos refused"},
    {"talus_messages_received_total", nullptr, nullptr, "Messages of streaming clients"},
    {"talus_views_cut_short_total", nullptr, nullptr, "Views that asked to reach further than view_far_m"},
    {"talus_sessions_ended_total", "reason", "malformed", "Sessions that the server ended"},
    {"talus_sessions_ended_total", "reason", "too_many_messages", ""},
    {"talus_sessions_ended_total", "reason", "too_slow", ""},
    {"talus_sessions_ended_total", "reason", "message_deadline", ""},
    {"talus_sessions_ended_total", "reason", "silent", ""},
    {"talus_sessions_ended_total", "reason", "draining", ""},
    {"talus_sessions_ended_total", "reason", "internal", ""},
    {"talus_chunks_sent_total", nullptr, nullptr, "Chunk messages sent on streams"},
    {"talus_chunk_bytes_sent_total", nullptr, nullptr, "Bytes of chunk messages sent on streams"},
    {"talus_send_shed_total", nullptr, nullptr, "Chunks taken back because a send queue was over its soft limit"},
    {"talus_send_overflow_total", nullptr, nullptr, "Sessions reset because a send queue met its hard limit"},
    {"talus_credit_waits_total", nullptr, nullptr, "Times a stream stopped because its client's credit was used up"},
}};

constexpr std::array<const char*, static_cast<std::size_t>(Hop::kEnd)> kHops{
    "read_loop", "next_message", "decode",  "on_message", "request", "load",        "build_chunk",  "encode_chunk",
    "draw_map",  "encode_map",   "publish", "write_loop", "queue",   "load_stored", "commit_stored"};

prometheus::ClientMetric::Histogram snapshot(const LatencyHistogram& from) {
  prometheus::ClientMetric::Histogram out;
  for (std::size_t i = 0; i < kLatencyBuckets; ++i) {
    out.sample_count += from.count(i);
    if (i + 1 < kLatencyBuckets) out.bucket.push_back({out.sample_count, LatencyHistogram::bound_seconds(i)});
  }
  out.sample_sum = from.total_seconds();
  return out;
}

std::uint64_t next_number() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

}  // namespace

Metrics::Metrics() : number_(next_number()) {}

Metrics::Page& Metrics::page_of_this_thread() {
  const std::lock_guard lock(pages_mutex_);
  const auto owner = std::this_thread::get_id();
  const auto known = std::ranges::find_if(pages_, [&](const auto& page) { return page->owner == owner; });
  if (known != pages_.end()) return **known;
  pages_.push_back(std::make_unique<Page>());
  pages_.back()->owner = owner;
  return *pages_.back();
}

std::uint64_t Metrics::value(Count count) const {
  const std::lock_guard lock(pages_mutex_);
  std::uint64_t sum = 0;
  for (const auto& page : pages_) sum += page->counts[static_cast<std::size_t>(count)].value();
  return sum;
}

void Metrics::add_up(Hop hop, LatencyHistogram& sum) const {
  const std::lock_guard lock(pages_mutex_);
  for (const auto& page : pages_) sum.add(page->hops[static_cast<std::size_t>(hop)]);
}

void Metrics::watch(ReadingInfo info, Reading reading) {
  const std::lock_guard lock(watched_mutex_);
  watched_.push_back({std::move(info), std::move(reading)});
}

std::string Metrics::text() const {
  std::vector<prometheus::MetricFamily> families;
  for (std::size_t i = 0; i < kCounts.size(); ++i) {
    const CountInfo& info = kCounts[i];
    if (families.empty() || families.back().name != info.family) {
      families.push_back({info.family, info.help, prometheus::MetricType::Counter, {}});
    }
    prometheus::ClientMetric& metric = families.back().metric.emplace_back();
    if (info.label != nullptr) metric.label.push_back({info.label, info.value});
    metric.counter.value = static_cast<double>(value(static_cast<Count>(i)));
  }
  prometheus::MetricFamily& hops = families.emplace_back();
  hops.name = "talus_hop_seconds";
  hops.help = "Time spent in each station of the data walk";
  hops.type = prometheus::MetricType::Histogram;
  for (std::size_t i = 0; i < kHops.size(); ++i) {
    prometheus::ClientMetric& metric = hops.metric.emplace_back();
    metric.label.push_back({"hop", kHops[i]});
    LatencyHistogram sum;
    add_up(static_cast<Hop>(i), sum);
    metric.histogram = snapshot(sum);
  }
  {
    const std::lock_guard lock(watched_mutex_);
    for (const auto& [info, reading] : watched_) {
      const auto type = info.is_counter ? prometheus::MetricType::Counter : prometheus::MetricType::Gauge;
      if (families.back().name != info.family) families.push_back({info.family, info.help, type, {}});
      prometheus::ClientMetric& metric = families.back().metric.emplace_back();
      if (!info.label.empty()) metric.label.push_back({info.label, info.label_value});
      (info.is_counter ? metric.counter.value : metric.gauge.value) = reading();
    }
  }
  const prometheus::TextSerializer serializer;
  return serializer.Serialize(families);
}

}  // namespace talus::server
