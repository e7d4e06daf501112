#include "server/cache/memory_cache.hpp"

#include <utility>

namespace talus::server {

void MemoryCache::Shard::link_newest(Entry& entry) {
  entry.older = newest;
  entry.newer = nullptr;
  if (newest != nullptr) newest->newer = &entry;
  newest = &entry;
  if (oldest == nullptr) oldest = &entry;
}

void MemoryCache::Shard::unlink(Entry& entry) {
  (entry.newer != nullptr ? entry.newer->older : newest) = entry.older;
  (entry.older != nullptr ? entry.older->newer : oldest) = entry.newer;
}

void MemoryCache::Shard::evict_oldest() {
  Entry& entry = *oldest;
  bytes -= entry.cost;
  unlink(entry);
  entries.erase(entries.find(*entry.name));
}

MemoryCache::MemoryCache(std::size_t bytes_max) : shard_bytes_max_(bytes_max / kShards) {}

MemoryCache::Shard& MemoryCache::shard_of(const PayloadName& name) {
  // The map inside a shard uses the low bits, so the shard is chosen by the high ones.
  return shards_[PayloadNameHash{}(name) >> 60];
}

PayloadRef MemoryCache::load(const PayloadName& name) {
  Shard& shard = shard_of(name);
  const std::lock_guard lock(shard.mutex);
  const auto found = shard.entries.find(name);
  if (found == shard.entries.end()) return nullptr;
  Entry& entry = found->second;
  if (shard.newest != &entry) {
    shard.unlink(entry);
    shard.link_newest(entry);
  }
  return entry.payload;
}

void MemoryCache::store(const PayloadName& name, PayloadRef payload) {
  const std::size_t cost = payload->bytes.capacity() + kCacheEntryOverheadBytes;
  if (cost > shard_bytes_max_) return;
  Shard& shard = shard_of(name);
  const std::lock_guard lock(shard.mutex);
  const auto [at, fresh] = shard.entries.try_emplace(name);
  Entry& entry = at->second;
  if (!fresh) {
    shard.bytes -= entry.cost;
    shard.unlink(entry);
  }
  entry.payload = std::move(payload);
  entry.name = &at->first;
  entry.cost = cost;
  shard.bytes += cost;
  shard.link_newest(entry);
  // The new entry alone fits, so this ends before it is reached.
  while (shard.bytes > shard_bytes_max_) shard.evict_oldest();
}

std::size_t MemoryCache::bytes() const {
  std::size_t sum = 0;
  for (const Shard& shard : shards_) {
    const std::lock_guard lock(shard.mutex);
    sum += shard.bytes;
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
