#include "server/cache/memory_cache.hpp"

#include <algorithm>
#include <utility>

namespace talus::server {

namespace {

/// The short queue's share of the bytes: long enough to be asked for again by the neighbours of whoever asked first.
constexpr std::size_t kSmallShare = 10;
constexpr std::uint8_t kUsesMax = 3;
/// Bytes of a shard for each ghost: chunks are 1.5 KiB in the mean, so about as many names are remembered as are held.
constexpr std::size_t kBytesPerGhost = 1536;
constexpr std::size_t kGhostsMin = 16;

}  // namespace

MemoryCache::MemoryCache(std::size_t bytes_max) : shard_bytes_max_(bytes_max / kShards) {
  for (Shard& shard : shards_) shard.ghosts.resize(std::max(kGhostsMin, shard_bytes_max_ / kBytesPerGhost));
}

MemoryCache::Shard& MemoryCache::shard_of(std::uint64_t hash) {
  // The map inside a shard uses the low bits, so the shard is chosen by the high ones.
  return shards_[hash >> 60];
}

PayloadRef MemoryCache::load(const PayloadName& name) {
  const std::size_t hash = PayloadNameHash{}(name);
  Shard& shard = shard_of(hash);
  const std::lock_guard lock(shard.mutex);
  const auto found = shard.entries.find(HashedName{name, hash});
  if (found == shard.entries.end()) {
    ++shard.totals.misses;
    return nullptr;
  }
  ++shard.totals.hits;
  Entry& entry = found->second;
  if (entry.uses < kUsesMax) ++entry.uses;
  return entry.payload;
}

void MemoryCache::store(const PayloadName& name, PayloadRef payload) {
  const std::size_t cost = payload->bytes.capacity() + kCacheEntryOverheadBytes;
  if (cost > shard_bytes_max_) return;
  const std::uint64_t hash = PayloadNameHash{}(name);
  Shard& shard = shard_of(hash);
  const std::lock_guard lock(shard.mutex);
  const auto known = shard.entries.find(name);
  const bool was_main = known != shard.entries.end() && known->second.is_main;
  if (known != shard.entries.end()) shard.forget(known->second);
  // Room is made first, so that a newcomer is not what goes.
  while (shard.bytes() + cost > shard_bytes_max_) shard.evict_one(shard_bytes_max_);
  const auto [at, fresh] = shard.entries.try_emplace(name);
  Entry& entry = at->second;
  entry.payload = std::move(payload);
  entry.name = &at->first;
  entry.cost = static_cast<std::uint32_t>(cost);
  std::uint64_t& ghost = shard.ghost_of(hash);
  entry.is_main = was_main || ghost == hash;
  ++shard.totals.stored;
  if (ghost == hash) ++shard.totals.recalled;
  if (ghost == hash) ghost = 0;
  (entry.is_main ? shard.main : shard.small).push(entry);
}

/// Requires an entry. What is used in the short queue moves to the long one, what is used in the long one goes round
/// once more for each use: an end is reached, since both only count down.
void MemoryCache::Shard::evict_one(std::size_t bytes_max) {
  for (;;) {
    const bool from_small =
        small.oldest != nullptr && (small.bytes * kSmallShare > bytes_max || main.oldest == nullptr);
    if (from_small ? evict_from_small() : evict_from_main()) return;
  }
}

bool MemoryCache::Shard::evict_from_small() {
  Entry& entry = *small.oldest;
  if (entry.uses == 0) {
    const std::uint64_t hash = PayloadNameHash{}(*entry.name);
    ghost_of(hash) = hash;
    ++totals.evicted;
    forget(entry);
    return true;
  }
  small.unlink(entry);
  entry.uses = 0;
  entry.is_main = true;
  main.push(entry);
  return false;
}

bool MemoryCache::Shard::evict_from_main() {
  Entry& entry = *main.oldest;
  if (entry.uses == 0) {
    ++totals.evicted;
    forget(entry);
    return true;
  }
  --entry.uses;
  main.unlink(entry);
  main.push(entry);
  return false;
}

void MemoryCache::Shard::forget(Entry& entry) {
  (entry.is_main ? main : small).unlink(entry);
  // A copy: the node that holds the name is what goes.
  entries.erase(PayloadName(*entry.name));
}

void MemoryCache::Queue::push(Entry& entry) {
  entry.newer = nullptr;
  entry.older = newest;
  (newest != nullptr ? newest->newer : oldest) = &entry;
  newest = &entry;
  bytes += entry.cost;
}

void MemoryCache::Queue::unlink(Entry& entry) {
  (entry.newer != nullptr ? entry.newer->older : newest) = entry.older;
  (entry.older != nullptr ? entry.older->newer : oldest) = entry.newer;
  bytes -= entry.cost;
}

MemoryCache::Totals MemoryCache::totals() const {
  Totals sum;
  for (const Shard& shard : shards_) {
    const std::lock_guard lock(shard.mutex);
    sum.hits += shard.totals.hits;
    sum.misses += shard.totals.misses;
    sum.stored += shard.totals.stored;
    sum.evicted += shard.totals.evicted;
    sum.recalled += shard.totals.recalled;
  }
  return sum;
}

std::size_t MemoryCache::bytes() const {
  std::size_t sum = 0;
  for (const Shard& shard : shards_) {
    const std::lock_guard lock(shard.mutex);
    sum += shard.bytes();
  }
  return sum;
}

std::size_t MemoryCache::entries() const {
  std::size_t sum = 0;
  for (const Shard& shard : shards_) {
    const std::lock_guard lock(shard.mutex);
    sum += shard.entries.size();
  }
  return sum;
}

}  // namespace talus::server
