#include "server/app/server.hpp"

#include <algorithm>
#include <array>
#include <thread>
#include <utility>
#include <vector>

#include "server/app/policy.hpp"
#include "server/app/world_files.hpp"
#include "server/observe/json.hpp"
#include "server/observe/log.hpp"
#include "server/observe/process_readings.hpp"
#include "server/world/stored_chunks.hpp"
#include "server/world/terrain_builder.hpp"

namespace talus::server {

namespace {

constexpr std::size_t kMiB = 1024 * 1024;
/// Threads of the pool that may take the place of hung ones; then each hung job costs one.
constexpr std::size_t kSpareThreads = 8;

std::size_t processors() {
  return std::max(1U, std::thread::hardware_concurrency());
}

std::size_t worker_threads(const Settings& settings) {
  return settings.threads != 0 ? settings.threads : processors();
}

std::size_t network_threads(const Settings& settings) {
  return settings.net_threads != 0 ? settings.net_threads : std::clamp<std::size_t>(processors() / 4, 1, 8);
}

std::expected<StaticFiles, std::string> load_viewer(const std::string& folder) {
  if (folder.empty()) return StaticFiles{};
  auto files = StaticFiles::load(folder);
  if (!files) return std::unexpected("viewer: " + files.error() + "\n");
  if (files->find("/") == nullptr) return std::unexpected("viewer: " + folder + " has no index.html\n");
  return files;
}

}  // namespace

/// In order of making; destroyed the other way round. The pool stops before the service its jobs belong to, the network
/// before both.
struct Server::Parts {
  Parts(Settings with, Worlds hosted, StaticFiles viewer, PolicyRef policy)
      : settings(std::move(with)),
        worlds(std::move(hosted)),
        files(std::move(viewer)),
        cache(settings.cache_mib * kMiB),
        stored(worlds),
        pool({worker_threads(settings), settings.cold_queue, settings.cold_per_client, settings.job_s, kSpareThreads,
              static_cast<int>(settings.pool_nice)}),
        builder(worlds, clock, metrics, pool.thread_indices()),
        chunks(cache, stored, pool, builder, clock, metrics),
        net{worlds, files, clock, chunks, pool, metrics, worlds_json(worlds), PolicySlot(std::move(policy)), {},
            {},     {},    {},    {},     {},   {}},
        network(net, network_threads(settings)) {}

  Settings settings;
  SystemClock clock;
  Metrics metrics;
  Worlds worlds;
  StaticFiles files;
  MemoryCache cache;
  StoredChunks stored;
  JobPool pool;
  TerrainBuilder builder;
  ChunkService chunks;
  NetContext net;
  NetServer network;
  std::string http_address;
  std::string tcp_address;
  std::string admin_address;
  std::string ready_line;
  bool is_stopped = false;

  std::expected<void, std::string> open_disk();
  bool speaks_tls(std::string_view listener) const;
  std::expected<void, std::string> listen();
  void add_readings();
  void write_ready_line();
};

std::expected<void, std::string> Server::Parts::open_disk() {
  if (settings.disk_cache.empty()) return {};
  auto disk =
      DiskCache::open({settings.disk_cache, settings.disk_cache_mib * kMiB, pool.thread_indices()}, clock, metrics);
  if (!disk) return std::unexpected("disk_cache: " + disk.error());
  stored.attach(std::move(*disk));
  return {};
}

bool Server::Parts::speaks_tls(std::string_view listener) const {
  if (settings.tls_certificate.empty()) return false;
  const auto& on = settings.tls_on;
  return on.empty() ? listener != "admin_listen" : std::find(on.begin(), on.end(), listener) != on.end();
}

std::expected<void, std::string> Server::Parts::listen() {
  const auto listen_on = [&](Listen kind, std::string_view key, const std::string& text,
                             std::string& bound) -> std::expected<void, std::string> {
    if (text == "off") return {};
    const auto endpoint = parse_endpoint(text);
    if (!endpoint) return std::unexpected(text + ": " + endpoint.error());
    auto address = network.listen(kind, *endpoint, speaks_tls(key));
    if (!address) return std::unexpected(address.error());
    bound = std::move(*address);
    return {};
  };
  if (auto done = listen_on(Listen::kHttp, "listen", settings.listen, http_address); !done) return done;
  if (auto done = listen_on(Listen::kTcp, "tcp_listen", settings.tcp_listen, tcp_address); !done) return done;
  return listen_on(Listen::kAdmin, "admin_listen", settings.admin_listen, admin_address);
}

void Server::Parts::add_readings() {
  const auto gauge = [&](const char* name, const char* help, Reading reading) {
    metrics.watch({name, help, {}, {}, false}, std::move(reading));
  };
  gauge("talus_ready", "1 while /readyz says so",
        [this] { return net.is_ready.load(std::memory_order_relaxed) ? 1.0 : 0.0; });
  gauge("talus_cache_bytes", "Memory cache, overhead included", [this] { return static_cast<double>(cache.bytes()); });
  gauge("talus_cache_bytes_max", "What the memory cache may take",
        [this] { return static_cast<double>(cache.bytes_max()); });
  gauge("talus_cache_entries", "Chunks in the memory cache", [this] { return static_cast<double>(cache.entries()); });
  using Totals = MemoryCache::Totals;
  constexpr std::array<std::pair<const char*, std::uint64_t Totals::*>, 5> kTotals{{{"hit", &Totals::hits},
                                                                                    {"miss", &Totals::misses},
                                                                                    {"stored", &Totals::stored},
                                                                                    {"evicted", &Totals::evicted},
                                                                                    {"recalled", &Totals::recalled}}};
  for (const auto& [outcome, total] : kTotals) {
    metrics.watch(
        {"talus_memory_cache_total", "Entries of the memory cache by what became of them", "outcome", outcome, true},
        [this, total = total] { return static_cast<double>(cache.totals().*total); });
  }
  if (const DiskCache* disk = stored.disk(); disk != nullptr) {
    gauge("talus_disk_cache_bytes", "Disk cache, as of its last commit",
          [disk] { return static_cast<double>(disk->bytes()); });
    gauge("talus_disk_cache_bytes_max", "What the disk cache may take",
          [disk] { return static_cast<double>(disk->bytes_max()); });
    gauge("talus_disk_cache_pending_bytes", "Chunks waiting to be written to the disk",
          [disk] { return static_cast<double>(disk->pending_bytes()); });
  }
  constexpr std::array<const char*, kLanes> kLaneNames{"feet", "view", "cover", "background"};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    metrics.watch({"talus_queue_jobs", "Jobs waiting, by lane", "lane", kLaneNames[lane], false},
                  [this, lane] { return static_cast<double>(pool.queued(static_cast<Lane>(lane))); });
  }
  gauge("talus_queue_jobs_max", "Jobs that may wait in a lane",
        [this] { return static_cast<double>(settings.cold_queue); });
  gauge("talus_queue_seconds", "When the last of the waiting jobs is expected to start",
        [this] { return pool.wait_s(); });
  gauge("talus_pool_threads", "Threads that make chunks, less those that hung jobs have cost",
        [this] { return static_cast<double>(pool.threads()); });
  gauge("talus_flights", "Chunks waiting or being made", [this] { return static_cast<double>(chunks.flights()); });
  gauge("talus_jobs_hanging", "Jobs that were given up and have not come back",
        [this] { return static_cast<double>(pool.hanging()); });
  metrics.watch({"talus_jobs_hung_total", "Jobs given up because they ran for job_s", {}, {}, true},
                [this] { return static_cast<double>(pool.hung()); });
  metrics.watch({"talus_jobs_failed_total", "Jobs that let an exception escape", {}, {}, true},
                [this] { return static_cast<double>(pool.failed()); });
  gauge("talus_connections", "Connections open", [this] { return static_cast<double>(net.connections.inside()); });
  gauge("talus_connections_max", "Connections that may be open",
        [this] { return static_cast<double>(net.policy.load()->limits.connections); });
  gauge("talus_tls_certificate_expires_seconds", "When the certificate ends, seconds since 1970; 0 without TLS",
        [this] {
          const PolicyRef policy = net.policy.load();
          return policy->tls == nullptr ? 0.0 : static_cast<double>(policy->tls->expires_unix_s());
        });
  gauge("talus_sessions", "Streaming sessions open",
        [this] { return static_cast<double>(net.sessions.load(std::memory_order_relaxed)); });
  gauge("talus_send_queue_bytes", "Frames waiting in all streams, behind what is being written",
        [this] { return static_cast<double>(net.queued_bytes.load(std::memory_order_relaxed)); });
  watch_process(metrics, clock.unix_seconds());
}

void Server::Parts::write_ready_line() {
  const auto address = [](const std::string& text) { return text.empty() ? std::string("null") : json_string(text); };
  ready_line = "{\"ready\":true,\"http\":" + address(http_address) + ",\"tcp\":" + address(tcp_address) +
               ",\"admin\":" + address(admin_address) + ",\"tls\":[";
  for (const std::string_view name : {"listen", "tcp_listen", "admin_listen"}) {
    if (!speaks_tls(name)) continue;
    if (ready_line.back() != '[') ready_line += ',';
    append_json_string(ready_line, name);
  }
  ready_line += "],\"worlds\":[";
  for (const auto& world : worlds) {
    if (ready_line.back() != '[') ready_line += ',';
    append_json_string(ready_line, world->name());
  }
  ready_line += "]}";
}

std::expected<std::unique_ptr<Server>, std::string> Server::start(const Settings& settings,
                                                                  std::function<void(Signal)> on_signal) {
  set_log_level(log_level(settings.log_level).value_or(LogLevel::kInfo));
  auto worlds = load_worlds(settings.world);
  if (!worlds) return std::unexpected(worlds.error());
  auto files = load_viewer(settings.viewer);
  if (!files) return std::unexpected(files.error());
  auto policy = make_policy(settings);
  if (!policy) return std::unexpected(policy.error());
  auto parts = std::make_unique<Parts>(settings, std::move(*worlds), std::move(*files), std::move(*policy));
  if (const auto opened = parts->open_disk(); !opened) return std::unexpected(opened.error() + "\n");
  if (const auto listening = parts->listen(); !listening) return std::unexpected(listening.error() + "\n");
  parts->add_readings();
  parts->write_ready_line();
  parts->network.start(std::move(on_signal));
  parts->net.is_ready.store(true, std::memory_order_relaxed);
  log(LogLevel::kInfo, "ready",
      {{"http", parts->http_address},
       {"tcp", parts->tcp_address},
       {"admin", parts->admin_address},
       {"threads", std::uint64_t{parts->pool.threads()}},
       {"cache_mib", std::uint64_t{settings.cache_mib}}});
  return std::unique_ptr<Server>(new Server(std::move(parts)));
}

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Server::~Server() {
  parts_->settings.drain_s = 0;
  stop();
  // A job that hangs still uses all of this, and cannot be ended.
  if (has_hung_job()) [[maybe_unused]]
    const Parts* left = parts_.release();
}

bool Server::has_hung_job() const {
  return parts_->pool.hanging() != 0;
}

const std::string& Server::ready_line() const {
  return parts_->ready_line;
}
const std::string& Server::http_address() const {
  return parts_->http_address;
}
const std::string& Server::tcp_address() const {
  return parts_->tcp_address;
}
const std::string& Server::admin_address() const {
  return parts_->admin_address;
}
const Metrics& Server::metrics() const {
  return parts_->metrics;
}

std::expected<void, std::string> Server::reload(const Settings& settings) {
  auto policy = make_policy(settings);
  Settings& old = parts_->settings;
  if (policy && settings.tls_certificate.empty() != old.tls_certificate.empty()) {
    policy = std::unexpected("tls_certificate: a listener takes up or gives up TLS only at a start\n");
  }
  if (!policy) {
    refuse_reload(policy.error());
    return std::unexpected(policy.error());
  }
  std::string waiting;
  for (const std::string_view key : fixed_differences(old, settings)) {
    waiting += (waiting.empty() ? "" : ", ") + std::string(key);
  }
  if (!waiting.empty()) log(LogLevel::kWarning, "settings that wait for a restart", {{"keys", waiting}});
  parts_->net.policy.store(std::move(*policy));
  set_log_level(log_level(settings.log_level).value_or(LogLevel::kInfo));
  old.log_level = settings.log_level;
  old.drain_s = settings.drain_s;
  parts_->metrics.add(Count::kReloads);
  log(LogLevel::kInfo, "settings reloaded");
  return {};
}

void Server::refuse_reload(std::string_view why) {
  parts_->metrics.add(Count::kReloadsRefused);
  log(LogLevel::kError, "settings not reloaded", {{"fault", why}});
}

void Server::stop() {
  if (std::exchange(parts_->is_stopped, true)) return;
  parts_->net.is_ready.store(false, std::memory_order_relaxed);
  log(LogLevel::kInfo, "draining", {{"connections", std::uint64_t{parts_->net.connections.inside()}}});
  parts_->network.stop(parts_->settings.drain_s);
  parts_->pool.stop();
  parts_->stored.flush();
  log(LogLevel::kInfo, "stopped");
}

}  // namespace talus::server
