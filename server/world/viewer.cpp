#include "server/world/viewer.hpp"

#include <algorithm>
#include <utility>

#include "core/grid/octree_order.hpp"
#include "protocol/limits.hpp"

namespace talus::server {

namespace {

/// protocol::chunk_urgency of the chunk one stands in, or touches, is at most this, wherever one looks.
constexpr double kFeetUrgency = 1.5;
/// From this LOD on a chunk is part of the skyline: 32 m * 2^4 = 512 m, seen from 2 km by default.
constexpr int kCoverLod = 4;

/// Urgency of the i-th explicit want: behind what a viewer stands on, ahead of the rest, in the client's own order.
double want_urgency(std::size_t i) {
  return 2.0 + static_cast<double>(i) / 64.0;
}

/// A strip is small, and what it closes is there already: ahead of chunks as near.
constexpr double kStripUrgency = 0.5;

/// Nothing a client says it holds is remembered beyond this.
constexpr std::size_t kHeldKeysMax = 2 * protocol::kWantedKeysMax;

/// What is not known of a held chunk's faces: any may be reached.
constexpr std::uint8_t kAllFaces = (1U << kChunkFaces) - 1;

/// Order of the states.
bool is_before(const Piece& a, const Piece& b) {
  return a.key != b.key ? is_before_in_octree(a.key, b.key) : a.face < b.face;
}

/// The first from `at` on that does not come before `piece`.
template <class Iterator>
Iterator skip_to(Iterator at, Iterator end, const Piece& piece) {
  while (at != end && at->piece != piece && is_before(at->piece, piece)) ++at;
  return at;
}

/// Order of the heap. Equal urgencies are ordered by piece, so that equal views give equal streams.
bool is_less_urgent(const WantedPiece& a, const WantedPiece& b) {
  return a.urgency != b.urgency ? a.urgency > b.urgency : a.piece > b.piece;
}

}  // namespace

Lane lane_of(const WantedPiece& wanted) {
  if (wanted.piece.key.lod == 0 && wanted.urgency <= kFeetUrgency) return Lane::kFeet;
  return wanted.piece.key.lod < kCoverLod ? Lane::kView : Lane::kCover;
}

Viewer::Viewer(const protocol::WorldShape& shape, std::uint64_t credit_bytes, bool takes_strips, double far_m_max)
    : shape_(shape), takes_strips_(takes_strips), far_m_max_(far_m_max), credit_bytes_(credit_bytes) {}

bool Viewer::on_message(const protocol::Message& message) {
  if (const auto* view = std::get_if<protocol::ViewMessage>(&message)) {
    view_ = protocol::ViewMessage{view->sequence, protocol::clamped(view->view, shape_)};
    is_view_cut_short_ = view_->view.far_m > far_m_max_;
    view_->view.far_m = std::min(view_->view.far_m, far_m_max_);
    is_view_new_ = true;
    is_stale_ = true;
  } else if (const auto* held = std::get_if<protocol::Held>(&message)) {
    hold(*held);
    // A resuming client says what it holds before it says what it sees: measured against no view at all, everything
    // would be left and then sent again.
    is_stale_ = is_stale_ || view_.has_value() || !want_.empty();
  } else if (const auto* want = std::get_if<protocol::Want>(&message)) {
    want_ = std::vector<ChunkKey>();
    want_.reserve(want->chunks.size());
    for (const protocol::HeldChunk& chunk : want->chunks) want_.push_back(chunk.key);
    want_strips_ = want->strips;
    is_stale_ = true;
  } else if (const auto* credit = std::get_if<protocol::Credit>(&message)) {
    // A sum no client can use up; saturates instead of wrapping.
    constexpr std::uint64_t kCreditMax = std::uint64_t{1} << 48;
    credit_bytes_ = std::min(kCreditMax, credit_bytes_ + std::min(kCreditMax, credit->bytes));
  } else {
    return false;
  }
  return true;
}

/// Keeps one state of each piece; all of one piece are in one phase and want the same.
void Viewer::sort_unique(States& states) {
  std::ranges::sort(states, is_before, &State::piece);
  const auto end =
      std::unique(states.begin(), states.end(), [](const State& a, const State& b) { return a.piece == b.piece; });
  states.erase(end, states.end());
}

Viewer::States::iterator Viewer::place_in(States& states, const Piece& piece) {
  return std::ranges::lower_bound(states, piece, is_before, &State::piece);
}

Viewer::State* Viewer::find_in(States& states, const Piece& piece) {
  const auto at = place_in(states, piece);
  return at == states.end() || at->piece != piece ? nullptr : &*at;
}

void Viewer::hold(const protocol::Held& held) {
  States fresh;
  for (std::size_t i = 0; i < held.chunks.size(); ++i) {
    const protocol::HeldChunk& chunk = held.chunks[i];
    // Without edits there is one revision; what a client holds of any other is not what the world is now.
    if (chunk.revision != 0) continue;
    const std::uint8_t faces = i < held.faces.size() ? held.faces[i] : kAllFaces;
    if (State* known = find({chunk.key, {}})) {
      // In flight already: it comes once more, which costs bytes but never a hole.
      if (known->phase != Phase::kWanted) continue;
      known->phase = Phase::kHeld;
      known->faces = faces;
      --wanted_;
    } else if (chunks_.size() + fresh.size() < kHeldKeysMax) {
      fresh.push_back({{chunk.key, {}}, Phase::kHeld, faces});
    }
  }
  chunks_.insert(chunks_.end(), fresh.begin(), fresh.end());
  sort_unique(chunks_);

  fresh.clear();
  for (const StripKey& strip : held.strips) {
    const Piece piece{strip.key, strip.face};
    if (State* known = find(piece)) {
      if (known->phase != Phase::kWanted) continue;
      known->phase = Phase::kHeld;
      --wanted_;
    } else if (strips_.size() + fresh.size() < kHeldKeysMax) {
      fresh.push_back({piece, Phase::kHeld});
    }
  }
  strips_.insert(strips_.end(), fresh.begin(), fresh.end());
  sort_unique(strips_);
}

Viewer::States Viewer::target() const {
  States out;
  if (area_) {
    std::vector<ChunkKey> area;
    area_->append_leaves(area);
    out.reserve(area.size() + want_.size());
    for (const ChunkKey& key : area) out.push_back({{key, {}}, Phase::kWanted, 0, true});
  }
  States wants;
  for (std::size_t i = 0; i < want_.size(); ++i)
    wants.push_back({{want_[i], {}}, Phase::kWanted, 0, false, want_urgency(i)});
  add_wants(out, std::move(wants));
  return out;
}

/// Of what is asked for twice, the more urgent; by name, that is the earlier.
void Viewer::add_wants(States& states, States wants) {
  if (wants.empty()) return;
  std::ranges::stable_sort(wants, is_before, &State::piece);
  States fresh;
  for (const State& want : wants) {
    if (State* known = find_in(states, want.piece)) {
      known->want_urgency = std::min(known->want_urgency, want.want_urgency);
    } else if (fresh.empty() || fresh.back().piece != want.piece) {
      fresh.push_back(want);
    }
  }
  const auto middle = states.insert(states.end(), fresh.begin(), fresh.end());
  std::ranges::inplace_merge(states, middle, is_before, &State::piece);
}

/// Of what is held nobody asks, so it is not kept but found when it is needed.
double Viewer::urgency_of(const State& state) {
  double urgency = state.want_urgency;
  if (!state.is_of_view) return urgency;
  if (!state.piece.face) return std::min(urgency, protocol::chunk_urgency(view_->view, shape_, state.piece.key));
  const State* chunk = find({state.piece.key, {}});
  return chunk == nullptr ? urgency : std::min(urgency, kStripUrgency * urgency_of(*chunk));
}

/// Both are sorted: one walk finds what stays, what comes and what goes.
void Viewer::merge_into(States& next, Change& change) {
  auto at = next.begin();
  for (const State& old : chunks_) {
    at = skip_to(at, next.end(), old.piece);
    if (at != next.end() && at->piece == old.piece) {
      at->phase = old.phase;
      at->faces = old.faces;
      if (old.phase == Phase::kInFlight) change.moved.push_back({old.piece, urgency_of(*at)});
    } else if (old.phase == Phase::kHeld) {
      change.leave.push_back(old.piece.key);
    } else if (old.phase == Phase::kInFlight) {
      change.cancelled.push_back(old.piece);
    }
  }
}

/// Whether it is among the chunks after a refresh, nearly always without looking for it there.
bool Viewer::is_of_target(const ChunkKey& key) {
  return (area_ && area_->has_leaf(key)) || (!want_.empty() && find({key, {}}) != nullptr);
}

/// Visits the strips that close a held chunk to the coarser chunks of the target around it.
template <class Visit>
void Viewer::for_each_strip_of(const State& finer, Visit visit) {
  if (finer.phase != Phase::kHeld || finer.faces == 0 || finer.piece.key.lod >= kLodMax) return;
  const ChunkKey parent = parent_of(finer.piece.key);
  for (const ChunkFace face : kAllChunkFaces) {
    if ((finer.faces & bit_of(face)) == 0) continue;
    const ChunkKey across = parent_of(neighbour_of(finer.piece.key, face));
    if (across == parent) continue;
    if (is_of_target(across)) visit(Piece{across, opposite(face)});
  }
}

/// Every strip that the target needs, as far as it is known.
Viewer::States Viewer::strips_of_target() {
  States out;
  for (const State& chunk : chunks_) {
    for_each_strip_of(chunk, [&](const Piece& strip) { out.push_back({strip, Phase::kWanted, 0, true}); });
  }
  sort_unique(out);
  States wants;
  for (std::size_t i = 0; i < want_strips_.size(); ++i) {
    wants.push_back({{want_strips_[i].key, want_strips_[i].face}, Phase::kWanted, 0, false, want_urgency(i)});
  }
  add_wants(out, std::move(wants));
  return out;
}

/// After the chunks are those of the new target. A held strip goes with its chunk, any other with the need for it. One
/// that was sent by name while its chunk was not of the target went when the client let that chunk go, which it does
/// without a word: with the chunk it is wanted again.
void Viewer::merge_strips(const States& before, Change& change) {
  States next = strips_of_target();
  States kept;
  auto at = next.begin();
  auto was = before.begin();
  for (const State& old : strips_) {
    const Piece chunk{old.piece.key, {}};
    was = skip_to(was, before.end(), chunk);
    const bool is_chunk_wanted = is_of_target(chunk.key);
    const bool is_lost = old.phase == Phase::kHeld && is_chunk_wanted && (was == before.end() || was->piece != chunk);
    at = skip_to(at, next.end(), old.piece);
    if (at != next.end() && at->piece == old.piece) {
      at->phase = is_lost ? Phase::kWanted : old.phase;
      if (old.phase == Phase::kInFlight) change.moved.push_back({old.piece, urgency_of(*at)});
    } else if (old.phase == Phase::kInFlight) {
      change.cancelled.push_back(old.piece);
    } else if (old.phase == Phase::kHeld && is_chunk_wanted && !is_lost) {
      kept.push_back(old);
    }
  }
  next.insert(next.end(), kept.begin(), kept.end());
  sort_unique(next);
  strips_ = std::move(next);
}

Viewer::Change Viewer::refresh() {
  Change change;
  if (is_view_new_) area_.emplace(view_->view, shape_);
  States next = target();
  merge_into(next, change);
  if (is_view_new_) {
    const auto chunks = static_cast<std::uint32_t>(next.size());
    change.accepted = protocol::ViewAccepted{view_->sequence, view_->view, chunks};
    change.is_cut_short = is_view_cut_short_;
  }
  std::swap(chunks_, next);
  if (takes_strips_) merge_strips(next, change);
  in_flight_ -= change.cancelled.size();
  queue_.clear();
  for (const States* states : {&chunks_, &strips_}) {
    for (const State& state : *states) {
      if (state.phase == Phase::kWanted) queue_.push_back({state.piece, urgency_of(state)});
    }
  }
  std::make_heap(queue_.begin(), queue_.end(), is_less_urgent);
  wanted_ = queue_.size();
  is_view_new_ = false;
  is_stale_ = false;
  is_idle_due_ = true;
  return change;
}

std::optional<WantedPiece> Viewer::next_request() {
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), is_less_urgent);
    const WantedPiece next = queue_.back();
    queue_.pop_back();
    State* state = find(next.piece);
    if (state == nullptr || state->phase != Phase::kWanted) continue;
    state->phase = Phase::kInFlight;
    --wanted_;
    ++in_flight_;
    return next;
  }
  return std::nullopt;
}

void Viewer::put_back(const Piece& piece) {
  State* state = find(piece);
  if (state == nullptr || state->phase != Phase::kInFlight) return;
  state->phase = Phase::kWanted;
  --in_flight_;
  ++wanted_;
  queue_.push_back({piece, urgency_of(*state)});
  std::push_heap(queue_.begin(), queue_.end(), is_less_urgent);
}

/// A chunk has just been sent: what closes it to its coarser neighbours is wanted now.
void Viewer::want_strips_of(const State& finer) {
  for_each_strip_of(finer, [&](const Piece& strip) {
    const auto at = place_in(strips_, strip);
    if (at != strips_.end() && at->piece == strip) return;
    const State wanted{strip, Phase::kWanted, 0, true};
    strips_.insert(at, wanted);
    queue_.push_back({strip, urgency_of(wanted)});
    std::push_heap(queue_.begin(), queue_.end(), is_less_urgent);
    ++wanted_;
  });
}

Viewer::Delivery Viewer::deliver(const Piece& piece, std::uint64_t message_bytes, unsigned faces) {
  State* state = find(piece);
  if (state == nullptr || state->phase != Phase::kInFlight) return Delivery::kUnwanted;
  if (message_bytes > credit_bytes_) return Delivery::kNoCredit;
  credit_bytes_ -= message_bytes;
  state->phase = Phase::kHeld;
  --in_flight_;
  if (piece.face) return Delivery::kSend;
  ++chunks_sent_;
  state->faces = static_cast<std::uint8_t>(faces);
  if (takes_strips_) want_strips_of(*state);
  return Delivery::kSend;
}

std::optional<protocol::Idle> Viewer::take_idle() {
  if (!is_idle_due_ || is_stale_ || wanted_ != 0 || in_flight_ != 0) return std::nullopt;
  is_idle_due_ = false;
  queue_ = std::vector<WantedPiece>();  // empty, but with room for a whole view: who stands still need not keep it
  return protocol::Idle{view_ ? view_->sequence : 0, chunks_sent_};
}

}  // namespace talus::server
