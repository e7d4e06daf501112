#include "server/cache/column_memo.hpp"

#include <utility>

#include "core/base/hash.hpp"

namespace talus::server {

std::size_t ColumnMemo::Hash::operator()(const ColumnName& name) const noexcept {
  const auto pair = [](std::uint32_t a, std::uint32_t b) { return (std::uint64_t{a} << 32) | b; };
  return static_cast<std::size_t>(mix64(pair(name.world, static_cast<std::uint32_t>(name.lod)),
                                        pair(static_cast<std::uint32_t>(name.x), static_cast<std::uint32_t>(name.z))));
}

bool ColumnMemo::load(const ColumnName& name, ColumnBlock& out) {
  Block block;
  {
    const std::lock_guard lock(mutex_);
    const auto found = places_.find(name);
    if (found == places_.end()) return false;
    order_.splice(order_.begin(), order_, found->second);
    block = found->second->second;
  }
  out = *block;
  return true;
}

void ColumnMemo::store(const ColumnName& name, const ColumnBlock& columns) {
  auto block = std::make_shared<const ColumnBlock>(columns);
  Block forgotten;  // destroyed outside the lock
  const std::lock_guard lock(mutex_);
  if (places_.contains(name)) return;
  order_.emplace_front(name, std::move(block));
  places_[name] = order_.begin();
  if (order_.size() <= blocks_max_) return;
  places_.erase(order_.back().first);
  forgotten = std::move(order_.back().second);
  order_.pop_back();
}

std::size_t ColumnMemo::blocks() const {
  const std::lock_guard lock(mutex_);
  return order_.size();
}

}  // namespace talus::server
