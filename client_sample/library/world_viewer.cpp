#include "client_sample/library/world_viewer.hpp"

#include <algorithm>
#include <deque>
#include <random>
#include <set>
#include <unordered_map>
#include <utility>

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>

#include "client_sample/library/decode_queue.hpp"
#include "client_sample/library/world_stream.hpp"
#include "core/base/check.hpp"

namespace talus::client {
namespace {

/// A connection that lasted this long was a good one: the next attempt after it does not wait for the ones before it.
constexpr std::chrono::seconds kGoodConnection{5};

}  // namespace

class WorldViewer::Session {
 public:
  Session(Loop& loop, ViewerOptions options)
      : loop_(loop), options_(std::move(options)), retry_(loop.context()), random_(std::random_device{}()) {
    TALUS_CHECK(options_.credit_bytes > 0);
    connect();
  }

  std::uint32_t look(const protocol::View& view) {
    view_ = view;
    ++looks_;
    if (stream_) note_look(stream_->look(view));
    return looks_;
  }

  void want(std::vector<ChunkKey> keys) {
    wanted_ = std::move(keys);
    if (stream_) send_want();
  }

  std::optional<ViewerEvent> next() {
    if (events_.empty()) return std::nullopt;
    Pending& front = events_.front();
    if (front.work && !decoding_.is_done(front.work, options_.decodes_in_next)) return std::nullopt;
    Pending taken = std::move(front);
    events_.pop_front();
    untaken_bytes_ -= taken.message_bytes;
    if (taken.message_bytes > 0 && stream_) stream_->give_credit(taken.message_bytes);
    if (!taken.work) return std::move(taken.event);
    if (taken.work->fault) return give_up(*taken.work->fault);
    if (auto* chunk = std::get_if<ChunkReady>(&taken.event)) chunk->mesh = std::move(taken.work->mesh);
    if (auto* strip = std::get_if<StripReady>(&taken.event)) strip->mesh = std::move(taken.work->mesh);
    return std::move(taken.event);
  }

  void close() {
    if (std::exchange(is_ended_, true)) return;
    retry_.cancel();
    if (is_closed_) {  // nothing is left that could end
      events_.push_back({Disconnected{{ErrorCode::kBye, "closed as asked", false}, std::nullopt}, nullptr, 0});
    } else {
      stream_->close();
    }
  }

  DecodeQueue& decoding() { return decoding_; }
  const std::optional<WorldInfo>& info() const { return info_; }
  bool is_connected() const { return is_connected_; }
  std::size_t held() const { return chunks_.size(); }

 private:
  using Clock = std::chrono::steady_clock;

  struct Pending {
    ViewerEvent event;
    DecodeQueue::WorkRef work;        ///< null: nothing has to be decoded
    std::uint64_t message_bytes = 0;  ///< of the credit
  };

  void connect() {
    stream_.reset();
    StreamOptions stream;
    stream.server = options_.server;
    stream.world = options_.world;
    stream.client = options_.client;
    stream.gives_credit_itself = true;
    // What lies here untaken is given back to the new connection as it is taken.
    stream.credit_bytes = options_.credit_bytes - std::min(options_.credit_bytes, untaken_bytes_);
    if (info_) stream.held_world_hash = info_->world_hash;
    for (const auto& [key, faces] : chunks_) {
      stream.held.push_back({key, 0});
      stream.held_faces.push_back(faces);
    }
    stream.held_strips.assign(strips_.begin(), strips_.end());
    began_ = Clock::now();
    is_closed_ = false;
    stream_.emplace(loop_, std::move(stream), handlers());
    if (view_) note_look(stream_->look(*view_));
    if (!wanted_.empty()) send_want();
  }

  StreamHandlers handlers() {
    StreamHandlers out;
    out.on_welcome = [this](const WorldInfo& info) { on_welcome(info); };
    out.on_chunk = [this](const ArrivedChunk& chunk) { on_chunk(chunk); };
    out.on_strip = [this](const ArrivedStrip& strip) { on_strip(strip); };
    out.on_failed = [this](const protocol::Failed& failed) {
      events_.push_back({Unmade{failed.key, failed.face}, nullptr, 0});
    };
    out.on_leave = [this](const std::vector<ChunkKey>& keys) { on_leave(keys); };
    out.on_idle = [this](const protocol::Idle& idle) { on_idle(idle); };
    out.on_closed = [this](const ClientError& error) { on_closed(error); };
    return out;
  }

  /// A stream counts its own looks from 1; the viewer's count goes on over all of them.
  void note_look(std::uint32_t of_stream) { looks_before_stream_ = looks_ - of_stream; }

  void send_want() {
    std::vector<protocol::HeldChunk> chunks;
    for (const ChunkKey& key : wanted_) chunks.push_back({key, 0});
    stream_->want(std::move(chunks));
  }

  void on_welcome(const WorldInfo& info) {
    is_connected_ = true;
    if (info_ && info_->world_hash != info.world_hash) {
      Forget forget;
      for (const auto& [key, faces] : chunks_) forget.keys.push_back(key);
      chunks_.clear();
      strips_.clear();
      if (!forget.keys.empty()) events_.push_back({std::move(forget), nullptr, 0});
    }
    info_ = info;
    events_.push_back({Connected{info}, nullptr, 0});
  }

  void on_chunk(const ArrivedChunk& chunk) {
    const protocol::ChunkHead& head = chunk.head;
    const auto lattice = protocol::mesh_lattice(head.key, info_->shape.cells, info_->shape.voxel_m);
    chunks_[head.key] = head.faces;
    Pending pending{ChunkReady{head.key, head.kind, head.faces, lattice.step_m, {}}, nullptr, chunk.message_bytes};
    if (head.kind == ChunkKind::kMesh) pending.work = decoding_.push(chunk.payload, lattice);
    keep(std::move(pending));
  }

  void on_strip(const ArrivedStrip& strip) {
    const StripKey& key = strip.head.strip;
    const auto lattice = protocol::strip_lattice(key.key, info_->shape.cells, info_->shape.voxel_m);
    strips_.insert(key);
    keep({StripReady{key, lattice.step_m, {}}, decoding_.push(strip.payload, lattice), strip.message_bytes});
  }

  void keep(Pending pending) {
    untaken_bytes_ += pending.message_bytes;
    events_.push_back(std::move(pending));
  }

  void on_leave(const std::vector<ChunkKey>& keys) {
    for (const ChunkKey& key : keys) {
      chunks_.erase(key);
      strips_.erase(strips_.lower_bound({key, kAllChunkFaces.front()}),
                    strips_.upper_bound({key, kAllChunkFaces.back()}));
    }
    events_.push_back({Forget{keys}, nullptr, 0});
  }

  void on_idle(const protocol::Idle& idle) {
    const Complete complete{idle.view_sequence == 0 ? 0 : looks_before_stream_ + idle.view_sequence};
    events_.push_back({complete, nullptr, 0});
  }

  void on_closed(const ClientError& error) {
    is_connected_ = false;
    is_closed_ = true;
    if (is_ended_ || !error.may_pass) {
      is_ended_ = true;
      events_.push_back({Disconnected{error, std::nullopt}, nullptr, 0});
      return;
    }
    if (Clock::now() - began_ >= kGoodConnection) attempts_ = 0;
    const auto doubled = options_.retry_min * (1 << std::min(attempts_++, 16));
    const auto wait = std::min<std::chrono::milliseconds>(doubled, options_.retry_max);
    const auto chance = std::uniform_int_distribution<std::int64_t>(0, wait.count() / 4)(random_);
    const auto retry_in = wait - std::chrono::milliseconds(chance);
    events_.push_back({Disconnected{error, retry_in}, nullptr, 0});
    retry_.expires_after(retry_in);
    retry_.async_wait([this, alive = std::weak_ptr<void>(alive_)](const asio::error_code& cancelled) {
      if (!cancelled && !alive.expired() && !is_ended_) connect();
    });
  }

  /// A server whose bytes are no surfaces would send the same again.
  ViewerEvent give_up(protocol::CodecError fault) {
    is_ended_ = true;
    is_connected_ = false;
    retry_.cancel();
    stream_.reset();
    is_closed_ = true;
    events_.clear();
    decoding_.clear();
    untaken_bytes_ = 0;
    return Disconnected{{ErrorCode::kProtocol, "a surface of the server: " + std::string(describe(fault)), false}, {}};
  }

  Loop& loop_;
  const ViewerOptions options_;
  std::optional<WorldInfo> info_;
  std::optional<protocol::View> view_;
  std::vector<ChunkKey> wanted_;
  std::uint32_t looks_ = 0;
  std::uint32_t looks_before_stream_ = 0;
  std::unordered_map<ChunkKey, std::uint8_t, ChunkKeyHash> chunks_;  ///< arrived and not left, with their faces
  std::set<StripKey> strips_;                                        ///< likewise
  DecodeQueue decoding_;
  std::deque<Pending> events_;
  std::uint64_t untaken_bytes_ = 0;
  int attempts_ = 0;
  bool is_connected_ = false;
  bool is_closed_ = false;  ///< the stream has ended: until the next attempt, or for good
  bool is_ended_ = false;   ///< there will be no other attempt
  Clock::time_point began_{};
  const std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a timer that fired may find the viewer gone
  asio::steady_timer retry_;
  std::mt19937_64 random_;
  std::optional<WorldStream> stream_;  ///< last: its handlers use all of the above
};

WorldViewer::WorldViewer(Loop& loop, ViewerOptions options)
    : session_(std::make_unique<Session>(loop, std::move(options))) {}
WorldViewer::~WorldViewer() = default;

std::uint32_t WorldViewer::look(const protocol::View& view) {
  return session_->look(view);
}
void WorldViewer::want(std::vector<ChunkKey> keys) {
  session_->want(std::move(keys));
}
std::optional<ViewerEvent> WorldViewer::next() {
  return session_->next();
}
bool WorldViewer::decode_one(std::chrono::milliseconds patience) {
  return session_->decoding().decode_one(patience);
}
void WorldViewer::stop_decoding() {
  session_->decoding().stop();
}
void WorldViewer::close() {
  session_->close();
}
const std::optional<WorldInfo>& WorldViewer::info() const {
  return session_->info();
}
bool WorldViewer::is_connected() const {
  return session_->is_connected();
}
std::size_t WorldViewer::held() const {
  return session_->held();
}

}  // namespace talus::client
