// talus pregen: makes a server fill its cache with a square of a world, so that whoever comes there is served at once.
//
// It is one more viewer: it wants chunks by name over the stream, a batch at a time, and so has one client's share of
// the server; people who play meanwhile keep theirs. What arrives is dropped. After every batch the count of columns
// that are done goes into the progress file, whole or not at all; a run with the same file, world and area goes on from
// there.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "client_sample/cli/interrupt.hpp"
#include "client_sample/cli/map_picture.hpp"
#include "client_sample/cli/pregen_plan.hpp"
#include "client_sample/cli/reach_server.hpp"
#include "client_sample/cli/text.hpp"
#include "client_sample/library/fetch_world.hpp"
#include "client_sample/library/world_stream.hpp"
#include "protocol/limits.hpp"

namespace talus::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kProgressBytesMax = 4096;
/// A batch takes a server seconds; one without a single chunk in this time is a server that has stopped.
constexpr double kSilent_s = 120;

/// How many columns are done, in a file that also says of what.
class ProgressFile {
 public:
  ProgressFile(std::string path, std::string what) : path_(std::move(path)), what_(std::move(what)) {}

  /// 0 when there is no file. kFailed: it is of something else, or says more than `columns`.
  std::expected<std::uint64_t, ExitCode> load(std::uint64_t columns) const {
    if (path_.empty() || !has_file(path_)) return 0;
    const auto text = load_file(path_, kProgressBytesMax);
    if (!text) return std::unexpected(kFailed);
    const std::size_t line = text->find('\n');
    std::uint64_t done = 0;
    const bool is_ours =
        line != std::string::npos && text->substr(0, line) == what_ &&
        std::from_chars(text->data() + line + 1, text->data() + text->size(), done).ec == std::errc{} &&
        done <= columns;
    if (is_ours) return done;
    fmt::print(stderr, "talus: {} is the progress of something else: remove it or name another file\n", path_);
    return std::unexpected(kFailed);
  }
  bool store(std::uint64_t done) const {
    return path_.empty() || replace_file(path_, fmt::format("{}\n{}\n", what_, done));
  }

 private:
  std::string path_;
  std::string what_;
};

/// The stream, one batch after another.
class Pregen {
 public:
  Pregen(client::Loop& loop, client::StreamOptions options, PregenPlan plan, std::uint64_t done)
      : loop_(loop), plan_(std::move(plan)), done_(done), stream_(loop, std::move(options), handlers()) {
    for (std::uint64_t i = 0; i < done; ++i) plan_.next();
  }

  /// True while there is something left; waits for the server in between.
  bool step() {
    if (batch_ == 0 && !want_next()) return false;
    loop_.run_for(std::chrono::milliseconds(20));
    if (std::chrono::duration<double>(Clock::now() - last_chunk_).count() > kSilent_s) {
      error_ = client::ClientError{client::ErrorCode::kTimeout, "the server has stopped to answer"};
    }
    return !error_;
  }
  std::uint64_t done() const { return done_; }
  std::uint64_t surfaces() const { return surfaces_; }
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t failures() const { return failures_; }
  std::uint64_t columns() const { return plan_.columns(); }
  const std::optional<client::ClientError>& error() const { return error_; }

 private:
  client::StreamHandlers handlers() {
    client::StreamHandlers out;
    out.on_chunk = [this](const client::ArrivedChunk& chunk) {
      last_chunk_ = Clock::now();
      surfaces_ += chunk.head.kind == ChunkKind::kMesh ? 1U : 0U;
      bytes_ += chunk.payload.size();
      if (!chunk.head.faces || chunk.head.key.lod == 0) return;
      for (const ChunkFace face : kAllChunkFaces) {
        if ((chunk.head.faces & bit_of(face)) != 0) strips_.push_back({chunk.head.key, face});
      }
    };
    out.on_strip = [this](const client::ArrivedStrip& strip) {
      last_chunk_ = Clock::now();
      bytes_ += strip.payload.size();
    };
    out.on_failed = [this](const protocol::Failed& failed) {
      last_chunk_ = Clock::now();
      ++failures_;
      fmt::print(stderr, "talus: the server cannot make {} {}/{}/{}/{}\n", failed.face ? "a strip of" : "chunk",
                 failed.key.lod, failed.key.x, failed.key.y, failed.key.z);
    };
    // What is wanted by name is complete: first the chunks, then the strips of those that have a surface.
    out.on_idle = [this](const protocol::Idle&) {
      if (!want_strips()) done_ += std::exchange(batch_, 0);
    };
    out.on_closed = [this](const client::ClientError& error) { error_ = error; };
    return out;
  }

  bool want_next() {
    std::vector<protocol::HeldChunk> chunks;
    while (true) {
      if (!column_) column_ = plan_.next();
      if (!column_) break;
      const std::vector<ChunkKey> keys = plan_.chunks_of(*column_);
      if (chunks.size() + keys.size() > protocol::kKeysPerMessageMax) break;
      for (const ChunkKey& key : keys) chunks.push_back({key, 0});
      column_.reset();
      ++batch_;
    }
    if (chunks.empty()) return false;
    last_chunk_ = Clock::now();
    stream_.want(std::move(chunks));
    return true;
  }

  bool want_strips() {
    if (strips_.empty()) return false;
    const std::size_t rest = strips_.size() - std::min(strips_.size(), protocol::kKeysPerMessageMax);
    std::vector<StripKey> part(strips_.begin() + static_cast<std::ptrdiff_t>(rest), strips_.end());
    strips_.resize(rest);
    stream_.want({}, std::move(part));
    return true;
  }

  client::Loop& loop_;
  PregenPlan plan_;
  std::optional<PregenPlan::Column> column_;  ///< did not fit into the batch before
  std::uint64_t batch_ = 0;                   ///< columns that are under way
  std::vector<StripKey> strips_;              ///< of the batch, not asked for yet
  std::uint64_t done_ = 0;
  std::uint64_t surfaces_ = 0;
  std::uint64_t bytes_ = 0;
  std::uint64_t failures_ = 0;
  Clock::time_point last_chunk_ = Clock::now();
  std::optional<client::ClientError> error_;
  client::WorldStream stream_;  ///< last: its handlers use all of the above
};

void print_progress(const Pregen& pregen, std::uint64_t began_at, double seconds) {
  const auto made = static_cast<double>(pregen.done() - began_at);
  const auto left = static_cast<double>(pregen.columns() - pregen.done());
  fmt::print(stderr, "{:6.0f} s  {}/{} columns ({:.1f} %)  {} surfaces  {:.1f} MB  {:.0f} s left\n", seconds,
             pregen.done(), pregen.columns(),
             100.0 * static_cast<double>(pregen.done()) / static_cast<double>(pregen.columns()), pregen.surfaces(),
             static_cast<double>(pregen.bytes()) / 1e6, made > 0 ? seconds / made * left : 0.0);
}

}  // namespace

ExitCode pregen(const PregenOptions& options) {
  const auto server = reach_server(options.server);
  if (!server) return server.error();
  const auto area = area_of(options.area);
  if (!area || options.lod_low > options.lod_high) return kUsage;
  const auto world = client::fetch_world(*server, options.server.world);
  if (!world) {
    fmt::print(stderr, "talus: {}\n", world.error());
    return kFailed;
  }
  const ProgressFile file(options.progress, fmt::format("talus pregen {} {} {}..{}", world->world_hash, options.area,
                                                        options.lod_low, options.lod_high));
  PregenPlan plan(world->shape, area->centre_m, area->edge_m, options.lod_low, options.lod_high);
  const auto began_at = file.load(plan.columns());
  if (!began_at) return began_at.error();

  catch_interrupt();
  client::Loop loop;
  client::StreamOptions stream;
  stream.server = *server;
  stream.world = options.server.world;
  stream.client = "talus pregen";
  Pregen pregen(loop, stream, std::move(plan), *began_at);
  const Clock::time_point began = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  std::uint64_t stored = *began_at;
  double next_line = 1;
  while (!is_interrupted() && seconds() < options.seconds && pregen.step()) {
    if (pregen.done() != stored && !file.store(stored = pregen.done())) return kFailed;
    if (seconds() < next_line) continue;
    print_progress(pregen, *began_at, seconds());
    next_line = seconds() + 1;
  }
  print_progress(pregen, *began_at, seconds());
  if (!file.store(pregen.done())) return kFailed;
  if (pregen.error()) fmt::print(stderr, "talus: {}\n", pregen.error()->message);
  fmt::print("{} of {} columns, {} surfaces, {} bytes\n", pregen.done(), pregen.columns(), pregen.surfaces(),
             pregen.bytes());
  if (pregen.error() || pregen.failures() != 0) return kFailed;
  return pregen.done() == pregen.columns() ? kDone : kIncomplete;
}

}  // namespace talus::cli
