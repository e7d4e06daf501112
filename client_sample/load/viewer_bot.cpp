#include "client_sample/load/viewer_bot.hpp"

#include <algorithm>
#include <utility>

namespace talus::load {
namespace {

/// As the browser viewer does.
constexpr double kLookEvery_s = 0.1;

}  // namespace

ViewerBot::ViewerBot(Stage& stage, Plan plan) : stage_(stage), plan_(std::move(plan)) {
  // What one resumes with has to be known, verified or not.
  if (plan_.is_verified || plan_.kind == BotKind::kReconnect) ledger_.emplace(stage.world.shape);
}

void ViewerBot::connect() {
  stream_.reset();
  client::StreamOptions options;
  options.server = group().carrier == client::Carrier::kTcp ? stage_.tcp : stage_.http;
  options.world = stage_.world.name;
  options.client = "talus load";
  options.credit_bytes = static_cast<std::uint64_t>(group().credit_mib * 1024 * 1024);
  options.gives_credit_itself = plan_.kind == BotKind::kSlow;
  if (ledger_ && is_resumed_) {
    for (const auto& [key, faces] : ledger_->held()) {
      options.held.push_back({key, 0});
      options.held_faces.push_back(faces);
    }
    ledger_->resumed();
  }
  info_known_ = false;
  has_looked_ = false;
  connected_s_ = stage_.now_s();
  next_look_s_ = stage_.now_s();
  next_jump_s_ = stage_.now_s() + group().every_s;
  stream_.emplace(stage_.loop, std::move(options), handlers());
}

client::StreamHandlers ViewerBot::handlers() {
  client::StreamHandlers out;
  out.on_welcome = [this](const client::WorldInfo&) {
    info_known_ = true;
    mine().record(Measure::kWelcome, stage_.now_s() - connected_s_);
  };
  out.on_view = [this](const protocol::ViewAccepted& accepted) {
    if (ledger_ && plan_.is_verified) ledger_->accepted(accepted);
  };
  out.on_chunk = [this](const client::ArrivedChunk& chunk) { on_chunk(chunk); };
  out.on_strip = [this](const client::ArrivedStrip& strip) {
    mine().count(Tally::kStrips);
    mine().count(Tally::kBytes, strip.payload.size());
    owed_bytes_ += strip.message_bytes;
  };
  out.on_failed = [this](const protocol::Failed& failed) {
    mine().count(Tally::kRefused);
    if (ledger_ && !failed.face) ledger_->refused(failed.key);
    tell_faults();
  };
  out.on_leave = [this](const std::vector<ChunkKey>& keys) {
    mine().count(Tally::kLeaves, keys.size());
    if (ledger_) ledger_->left(keys);
  };
  out.on_idle = [this](const protocol::Idle& idle) { on_idle(idle); };
  out.on_closed = [this](const client::ClientError& error) { on_closed(error); };
  return out;
}

void ViewerBot::tick(double now_s) {
  if (is_over_ || is_leaving_ || now_s < plan_.start_s) return;
  if (!stream_) connect();
  if (now_s >= next_jump_s_) {
    next_jump_s_ = now_s + group().every_s;
    if (plan_.kind == BotKind::kReconnect) return drop_and_resume();
    if (plan_.kind == BotKind::kTeleport) {
      way_ = (way_ + 1) % plan_.ways.size();
      has_looked_ = false;
    }
  }
  const bool is_still = plan_.ways[way_].velocity(now_s) == glm::dvec3{};
  if (now_s >= next_look_s_ && !(is_still && has_looked_)) look(now_s);
  if (plan_.kind == BotKind::kSlow) {
    const double may_return = group().rate * (now_s - std::exchange(paid_s_, now_s));
    const auto bytes = std::min(owed_bytes_, static_cast<std::uint64_t>(may_return));
    owed_bytes_ -= bytes;
    stream_->give_credit(bytes);
  }
  // It has begun to take chunks, so the server believes in it.
  if (plan_.kind == BotKind::kStall && has_chunk_ && !is_stalled_) {
    is_stalled_ = true;
    stalled_s_ = now_s;
    stream_->stall();
  }
}

void ViewerBot::look(double now_s) {
  const Way& way = plan_.ways[way_];
  view_ = {};
  view_.position = way.at(now_s);
  view_.velocity = way.velocity(now_s);
  if (view_.velocity != glm::dvec3{}) view_.direction = view_.velocity;
  view_.near_m = stage_.scenario.near_m;
  view_.far_m = group().far_m;
  const std::uint32_t sequence = stream_->look(view_);
  mine().count(Tally::kLooks);
  if (ledger_ && plan_.is_verified) ledger_->looked(sequence, now_s);
  next_look_s_ = now_s + kLookEvery_s;
  has_looked_ = true;
}

/// As a client whose network was gone: without goodbye.
void ViewerBot::drop_and_resume() {
  mine().count(Tally::kReconnects);
  is_resumed_ = true;
  connect();
}

void ViewerBot::on_chunk(const client::ArrivedChunk& chunk) {
  const protocol::ChunkHead& head = chunk.head;
  mine().count(Tally::kChunks);
  mine().count(Tally::kBytes, chunk.payload.size());
  owed_bytes_ += chunk.message_bytes;
  if (!std::exchange(has_chunk_, true)) mine().record(Measure::kFirstChunk, stage_.now_s() - connected_s_);
  if (head.kind == ChunkKind::kMesh) {
    mine().count(Tally::kSurfaces);
    if (!has_ground_ && head.key.lod == 0 && is_below(head.key)) {
      has_ground_ = true;
      mine().record(Measure::kGround, stage_.now_s() - connected_s_);
    }
  }
  stage_.samples.offer(head.key, head.kind, chunk.payload);
  if (!ledger_) return;
  const auto waited_s = ledger_->came(head, stage_.now_s());
  if (waited_s && plan_.is_verified) mine().record(Measure::kChunk, *waited_s);
  tell_faults();
}

bool ViewerBot::is_below(const ChunkKey& key) const {
  const BoxWorld box = box_of(key, stage_.world.shape.cells, stage_.world.shape.voxel_m);
  return view_.position.x >= box.low.x && view_.position.x < box.high.x && view_.position.z >= box.low.z &&
         view_.position.z < box.high.z && box.low.y <= view_.position.y;
}

void ViewerBot::on_idle(const protocol::Idle& idle) {
  if (ledger_ && plan_.is_verified) {
    ledger_->complete(idle);
    tell_faults();
  }
  if (idle.view_sequence == 0 || std::exchange(has_complete_, true)) {
    if (idle.view_sequence == 1 && is_resumed_) mine().record(Measure::kResume, stage_.now_s() - connected_s_);
    return;
  }
  mine().record(Measure::kComplete, stage_.now_s() - connected_s_);
}

void ViewerBot::on_closed(const client::ClientError& error) {
  is_over_ = true;
  if (is_leaving_) return;
  if (is_stalled_) {
    mine().record(Measure::kCut, stage_.now_s() - stalled_s_);
  } else {
    mine().count(Tally::kBroken);
  }
  stage_.report.ended(error.message);
}

void ViewerBot::tell_faults() {
  if (!ledger_) return;
  for (std::string& what : ledger_->take_faults()) {
    stage_.report.fault(std::string(name_of(plan_.kind)) + ": " + std::move(what));
  }
}

void ViewerBot::leave() {
  is_leaving_ = true;
  if (stream_ && !is_over_) stream_->close();
}

}  // namespace talus::load
