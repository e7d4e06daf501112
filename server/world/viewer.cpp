#include "server/world/viewer.hpp"

#include <algorithm>
#include <utility>

#include "protocol/limits.hpp"

namespace talus::server {

namespace {

/// Urgency of the i-th explicit want: ahead of all but the nearest of a view, in the client's own order.
double want_urgency(std::size_t i) {
  return static_cast<double>(i) / 64.0;
}

/// Nothing a client says it holds is remembered beyond this.
constexpr std::size_t kHeldKeysMax = 2 * protocol::kWantedKeysMax;

/// Order of the heap. Equal urgencies are ordered by key, so that equal views give equal streams.
bool is_less_urgent(const WantedChunk& a, const WantedChunk& b) {
  return a.urgency != b.urgency ? a.urgency > b.urgency : a.key > b.key;
}

}  // namespace

Viewer::Viewer(const protocol::WorldShape& shape, std::uint64_t credit_bytes)
    : shape_(shape), credit_bytes_(credit_bytes) {}

bool Viewer::on_message(const protocol::Message& message) {
  if (const auto* view = std::get_if<protocol::ViewMessage>(&message)) {
    view_ = protocol::ViewMessage{view->sequence, protocol::clamped(view->view, shape_)};
    is_view_new_ = true;
    is_stale_ = true;
  } else if (const auto* held = std::get_if<protocol::Held>(&message)) {
    hold(held->chunks);
    // A resuming client says what it holds before it says what it sees: measured against no view at all, everything
    // would be left and then sent again.
    is_stale_ = is_stale_ || view_.has_value() || !want_.empty();
  } else if (const auto* want = std::get_if<protocol::Want>(&message)) {
    want_.clear();
    for (const protocol::HeldChunk& chunk : want->chunks) want_.push_back(chunk.key);
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

/// Keeps, of each key, the most urgent state; all of one key are in one phase.
void Viewer::sort_unique(States& states) {
  std::sort(states.begin(), states.end(),
            [](const State& a, const State& b) { return a.key != b.key ? a.key < b.key : a.urgency < b.urgency; });
  const auto end =
      std::unique(states.begin(), states.end(), [](const State& a, const State& b) { return a.key == b.key; });
  states.erase(end, states.end());
}

Viewer::State* Viewer::find(const ChunkKey& key) {
  const auto at = std::lower_bound(states_.begin(), states_.end(), key,
                                   [](const State& state, const ChunkKey& k) { return state.key < k; });
  return at == states_.end() || at->key != key ? nullptr : &*at;
}

void Viewer::hold(const std::vector<protocol::HeldChunk>& chunks) {
  States fresh;
  for (const protocol::HeldChunk& chunk : chunks) {
    // Without edits there is one revision; what a client holds of any other is not what the world is now.
    if (chunk.revision != 0) continue;
    if (State* known = find(chunk.key)) {
      // In flight already: it comes once more, which costs bytes but never a hole.
      if (known->phase != Phase::kWanted) continue;
      known->phase = Phase::kHeld;
      --wanted_;
    } else if (states_.size() + fresh.size() < kHeldKeysMax) {
      fresh.push_back({chunk.key, 0.0, Phase::kHeld});
    }
  }
  states_.insert(states_.end(), fresh.begin(), fresh.end());
  sort_unique(states_);
}

Viewer::States Viewer::target() const {
  States out;
  if (view_) {
    std::vector<ChunkKey> area;
    protocol::interest_area(view_->view, shape_, area);
    out.reserve(area.size() + want_.size());
    for (const ChunkKey& key : area) {
      out.push_back({key, protocol::chunk_urgency(view_->view, shape_, key), Phase::kWanted});
    }
  }
  for (std::size_t i = 0; i < want_.size(); ++i) out.push_back({want_[i], want_urgency(i), Phase::kWanted});
  sort_unique(out);
  return out;
}

/// Both are sorted: one walk finds what stays, what comes and what goes.
void Viewer::merge_into(States& next, Change& change) const {
  auto at = next.begin();
  for (const State& old : states_) {
    while (at != next.end() && at->key < old.key) ++at;
    if (at != next.end() && at->key == old.key) {
      at->phase = old.phase;
      if (old.phase == Phase::kInFlight) change.moved.push_back({old.key, at->urgency});
    } else if (old.phase == Phase::kHeld) {
      change.leave.push_back(old.key);
    } else if (old.phase == Phase::kInFlight) {
      change.cancelled.push_back(old.key);
    }
  }
}

Viewer::Change Viewer::refresh() {
  Change change;
  States next = target();
  merge_into(next, change);
  in_flight_ -= change.cancelled.size();
  if (is_view_new_) {
    const auto chunks = static_cast<std::uint32_t>(next.size());
    change.accepted = protocol::ViewAccepted{view_->sequence, view_->view, chunks};
  }
  states_ = std::move(next);
  queue_.clear();
  for (const State& state : states_) {
    if (state.phase == Phase::kWanted) queue_.push_back({state.key, state.urgency});
  }
  std::make_heap(queue_.begin(), queue_.end(), is_less_urgent);
  wanted_ = queue_.size();
  is_view_new_ = false;
  is_stale_ = false;
  is_idle_due_ = true;
  return change;
}

std::optional<WantedChunk> Viewer::next_request() {
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), is_less_urgent);
    const WantedChunk next = queue_.back();
    queue_.pop_back();
    State* state = find(next.key);
    if (state == nullptr || state->phase != Phase::kWanted) continue;
    state->phase = Phase::kInFlight;
    --wanted_;
    ++in_flight_;
    return next;
  }
  return std::nullopt;
}

void Viewer::put_back(const ChunkKey& key) {
  State* state = find(key);
  if (state == nullptr || state->phase != Phase::kInFlight) return;
  state->phase = Phase::kWanted;
  --in_flight_;
  ++wanted_;
  queue_.push_back({key, state->urgency});
  std::push_heap(queue_.begin(), queue_.end(), is_less_urgent);
}

Viewer::Delivery Viewer::deliver(const ChunkKey& key, std::uint64_t message_bytes) {
  State* state = find(key);
  if (state == nullptr || state->phase != Phase::kInFlight) return Delivery::kUnwanted;
  if (message_bytes > credit_bytes_) return Delivery::kNoCredit;
  credit_bytes_ -= message_bytes;
  state->phase = Phase::kHeld;
  --in_flight_;
  ++chunks_sent_;
  return Delivery::kSend;
}

std::optional<protocol::Idle> Viewer::take_idle() {
  if (!is_idle_due_ || is_stale_ || wanted_ != 0 || in_flight_ != 0) return std::nullopt;
  is_idle_due_ = false;
  return protocol::Idle{view_ ? view_->sequence : 0, chunks_sent_};
}

}  // namespace talus::server
