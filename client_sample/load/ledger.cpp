#include "client_sample/load/ledger.hpp"

#include <algorithm>
#include <utility>

namespace talus::load {
namespace {

/// Views that a server never accepts, since newer ones overtook them, are not remembered for ever.
constexpr std::size_t kLooksMax = 1024;
constexpr std::size_t kFaultsMax = 64;

std::string text_of(const ChunkKey& key) {
  return std::to_string(key.lod) + '/' + std::to_string(key.x) + '/' + std::to_string(key.y) + '/' +
         std::to_string(key.z);
}

}  // namespace

void Ledger::fault(const ChunkKey& key, const char* what) {
  if (faults_.size() < kFaultsMax) faults_.push_back("chunk " + text_of(key) + ' ' + what);
}

void Ledger::looked(std::uint32_t sequence, double now_s) {
  last_look_ = sequence;
  looks_[sequence] = now_s;
  if (looks_.size() > kLooksMax) looks_.erase(looks_.begin());
}

void Ledger::ask(const std::vector<ChunkKey>& keys, double since_s) {
  expected_ = keys;
  std::ranges::sort(expected_);
  std::unordered_map<ChunkKey, double, ChunkKeyHash> asked;
  for (const ChunkKey& key : expected_) {
    if (held_.contains(key) || refused_.contains(key)) continue;
    const auto before = asked_.find(key);
    asked[key] = before == asked_.end() ? since_s : before->second;
  }
  asked_ = std::move(asked);
}

void Ledger::accepted(const protocol::ViewAccepted& accepted) {
  accepted_ = accepted.sequence;
  const auto look = looks_.find(accepted.sequence);
  if (look == looks_.end()) return;
  const double since_s = look->second;
  looks_.erase(looks_.begin(), std::next(look));
  std::vector<ChunkKey> area;
  protocol::interest_area(accepted.view, shape_, area);
  if (area.size() != accepted.chunks && faults_.size() < kFaultsMax) {
    faults_.push_back("the server counts " + std::to_string(accepted.chunks) + " chunks in a view of " +
                      std::to_string(area.size()));
  }
  ask(area, since_s);
}

void Ledger::wanted(const std::vector<ChunkKey>& keys, double now_s) {
  ask(keys, now_s);
}

std::optional<double> Ledger::came(const protocol::ChunkHead& head, double now_s) {
  if (!held_.emplace(head.key, head.faces).second) fault(head.key, "came a second time");
  if (refused_.contains(head.key)) fault(head.key, "came though it had been refused");
  const auto asked = asked_.find(head.key);
  if (asked == asked_.end()) return std::nullopt;
  const double waited_s = now_s - asked->second;
  asked_.erase(asked);
  return waited_s;
}

void Ledger::refused(const ChunkKey& key) {
  if (held_.contains(key)) fault(key, "was refused after it had come");
  if (!refused_.insert(key).second) fault(key, "was refused a second time");
  asked_.erase(key);
}

void Ledger::left(const std::vector<ChunkKey>& keys) {
  for (const ChunkKey& key : keys) {
    if (held_.erase(key) + refused_.erase(key) == 0) fault(key, "was left without having come");
  }
}

void Ledger::complete(const protocol::Idle& idle) {
  // Of an older view: the next one is on its way.
  if (idle.view_sequence != 0 && (accepted_ != idle.view_sequence || last_look_ != idle.view_sequence)) return;
  for (const ChunkKey& key : expected_) {
    if (!held_.contains(key) && !refused_.contains(key)) fault(key, "never came, and the view is called complete");
  }
  if (held_.size() + refused_.size() <= expected_.size()) return;
  for (const auto& [key, faces] : held_) {
    if (!std::ranges::binary_search(expected_, key)) fault(key, "is not part of the view and was not left");
  }
}

void Ledger::resumed() {
  looks_.clear();
  refused_.clear();
  asked_.clear();
  expected_.clear();
  accepted_.reset();
  last_look_ = 0;
}

std::vector<std::string> Ledger::take_faults() {
  return std::exchange(faults_, {});
}

}  // namespace talus::load
