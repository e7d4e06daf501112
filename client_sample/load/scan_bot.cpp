#include "client_sample/load/scan_bot.hpp"

#include <algorithm>
#include <cmath>

namespace talus::load {
namespace {

/// Enough that the server is never without the next one, few enough that every batch is a round trip's worth of work.
constexpr std::size_t kBatch = 256;
/// Where most of a world's ground is, so that most of what is asked for has to be made and is not ruled out.
constexpr double kGroundLow_m = 0;
constexpr double kGroundHigh_m = 800;
constexpr int kScanLodMax = 4;

}  // namespace

ScanBot::ScanBot(Stage& stage, double start_s, std::uint64_t seed)
    : stage_(stage), start_s_(start_s), random_(seed), ledger_(stage.world.shape) {}

void ScanBot::connect() {
  client::StreamOptions options;
  options.server = group().carrier == client::Carrier::kTcp ? stage_.tcp : stage_.http;
  options.world = stage_.world.name;
  options.client = "talus load";
  options.credit_bytes = static_cast<std::uint64_t>(group().credit_mib * 1024 * 1024);
  client::StreamHandlers handlers;
  handlers.on_welcome = [this](const client::WorldInfo&) {
    is_known_ = true;
    mine().record(Measure::kWelcome, stage_.now_s() - connected_s_);
    want_next();
  };
  handlers.on_chunk = [this](const client::ArrivedChunk& chunk) {
    mine().count(Tally::kChunks);
    mine().count(Tally::kAnswered);
    mine().count(Tally::kSurfaces, chunk.head.kind == ChunkKind::kMesh ? 1 : 0);
    mine().count(Tally::kBytes, chunk.payload.size());
    stage_.samples.offer(chunk.head.key, chunk.head.kind, chunk.payload);
    if (const auto waited_s = ledger_.came(chunk.head, stage_.now_s())) mine().record(Measure::kChunk, *waited_s);
    tell_faults();
  };
  handlers.on_failed = [this](const protocol::Failed& failed) {
    mine().count(Tally::kRefused);
    if (!failed.face) ledger_.refused(failed.key);
    tell_faults();
  };
  handlers.on_leave = [this](const std::vector<ChunkKey>& keys) {
    mine().count(Tally::kLeaves, keys.size());
    ledger_.left(keys);
  };
  handlers.on_idle = [this](const protocol::Idle& idle) {
    ledger_.complete(idle);
    tell_faults();
    if (!is_leaving_) want_next();
  };
  handlers.on_closed = [this](const client::ClientError& error) {
    is_over_ = true;
    if (is_leaving_) return;
    mine().count(Tally::kBroken);
    stage_.report.ended(error.message);
  };
  connected_s_ = stage_.now_s();
  stream_.emplace(stage_.loop, std::move(options), std::move(handlers));
}

ChunkKey ScanBot::random_key() {
  const client::WorldInfo& world = stage_.world;
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random_); };
  ChunkKey key;
  key.lod = static_cast<std::int32_t>(random_() % (kScanLodMax + 1));
  const double edge = std::ldexp(world.shape.cells * world.shape.voxel_m, key.lod);
  const auto chunk = [&](double metres) { return static_cast<std::int32_t>(std::floor(metres / edge)); };
  const double reach = group().spread_m;
  key.x = chunk(stage_.scenario.x_m + between(-reach, reach));
  key.y = chunk(between(kGroundLow_m, kGroundHigh_m));
  key.z = chunk(stage_.scenario.z_m + between(-reach, reach));
  return key;
}

void ScanBot::want_next() {
  std::vector<ChunkKey> keys;
  while (keys.size() < kBatch) {
    const ChunkKey key = random_key();
    if (is_valid(key)) keys.push_back(key);
  }
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::ranges::shuffle(keys, random_);
  std::vector<protocol::HeldChunk> chunks;
  chunks.reserve(keys.size());
  for (const ChunkKey& key : keys) chunks.push_back({key, 0});
  mine().count(Tally::kAsked, keys.size());
  ledger_.wanted(keys, stage_.now_s());
  stream_->want(std::move(chunks));
}

void ScanBot::tick(double now_s) {
  if (!stream_ && now_s >= start_s_ && !is_leaving_) connect();
}

void ScanBot::tell_faults() {
  for (std::string& what : ledger_.take_faults()) stage_.report.fault("scan: " + std::move(what));
}

void ScanBot::leave() {
  is_leaving_ = true;
  if (stream_ && !is_over_) stream_->close();
}

}  // namespace talus::load
