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

void Viewer::hold(const std::vector<protocol::HeldChunk>& chunks) {
  for (const protocol::HeldChunk& chunk : chunks) {
    // Without edits there is one revision; what a client holds of any other is not what the world is now.
    if (chunk.revision != 0 || states_.size() >= kHeldKeysMax) continue;
    const auto [at, fresh] = states_.try_emplace(chunk.key);
    if (fresh) {
      at->second.phase = Phase::kHeld;
    } else if (at->second.phase == Phase::kWanted) {
      at->second.phase = Phase::kHeld;
      --wanted_;
    }
    // In flight already: it comes once more, which costs bytes but never a hole.
  }
}

Viewer::States Viewer::target() const {
  States out;
  if (view_) {
    std::vector<ChunkKey> area;
    protocol::interest_area(view_->view, shape_, area);
    out.reserve(area.size() + want_.size());
    for (const ChunkKey& key : area) out[key].urgency = protocol::chunk_urgency(view_->view, shape_, key);
  }
  for (std::size_t i = 0; i < want_.size(); ++i) {
    const auto [at, fresh] = out.try_emplace(want_[i]);
    at->second.urgency = fresh ? want_urgency(i) : std::min(at->second.urgency, want_urgency(i));
  }
  return out;
}

Viewer::Change Viewer::refresh() {
  Change change;
  States next = target();
  for (const auto& [key, state] : states_) {
    const auto kept = next.find(key);
    if (kept != next.end()) {
      kept->second.phase = state.phase;
      if (state.phase == Phase::kInFlight) change.moved.push_back({key, kept->second.urgency});
    } else if (state.phase == Phase::kHeld) {
      change.leave.push_back(key);
    } else if (state.phase == Phase::kInFlight) {
      change.cancelled.push_back(key);
    }
  }
  in_flight_ -= change.cancelled.size();
  if (is_view_new_) {
    const auto chunks = static_cast<std::uint32_t>(next.size());
    change.accepted = protocol::ViewAccepted{view_->sequence, view_->view, chunks};
  }
  states_ = std::move(next);
  queue_.clear();
  for (const auto& [key, state] : states_) {
    if (state.phase == Phase::kWanted) queue_.push_back({key, state.urgency});
  }
  wanted_ = queue_.size();
  // Equal urgencies are ordered by key, so that equal views give equal streams.
  std::sort(queue_.begin(), queue_.end(), [](const WantedChunk& a, const WantedChunk& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.key > b.key;
  });
  is_view_new_ = false;
  is_stale_ = false;
  is_idle_due_ = true;
  return change;
}

std::optional<WantedChunk> Viewer::next_request() {
  while (!queue_.empty()) {
    const WantedChunk next = queue_.back();
    queue_.pop_back();
    const auto found = states_.find(next.key);
    if (found == states_.end() || found->second.phase != Phase::kWanted) continue;
    found->second.phase = Phase::kInFlight;
    --wanted_;
    ++in_flight_;
    return next;
  }
  return std::nullopt;
}

void Viewer::put_back(const ChunkKey& key) {
  const auto found = states_.find(key);
  if (found == states_.end() || found->second.phase != Phase::kInFlight) return;
  found->second.phase = Phase::kWanted;
  --in_flight_;
  ++wanted_;
  const WantedChunk chunk{key, found->second.urgency};
  const auto place = std::upper_bound(queue_.begin(), queue_.end(), chunk,
                                      [](const WantedChunk& a, const WantedChunk& b) { return a.urgency > b.urgency; });
  queue_.insert(place, chunk);
}

Viewer::Delivery Viewer::deliver(const ChunkKey& key, std::uint64_t message_bytes) {
  const auto found = states_.find(key);
  if (found == states_.end() || found->second.phase != Phase::kInFlight) return Delivery::kUnwanted;
  if (message_bytes > credit_bytes_) return Delivery::kNoCredit;
  credit_bytes_ -= message_bytes;
  found->second.phase = Phase::kHeld;
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
