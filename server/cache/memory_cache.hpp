// Encoded chunks in memory, bounded in bytes, the longest unused evicted first. Any thread.
//
// Sharded by hash, each shard with its own lock, list and share of the bytes, so network threads that answer from
// memory do not wait for one another. A payload that was handed out lives on in its holders after it is evicted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <unordered_map>

#include "server/cache/payload.hpp"

namespace talus::server {

/// What an entry costs beside its payload's bytes: map node 104 B, bucket 8 B, payload with its control block 56 B,
/// and malloc's 16 B and rounding for each of the three allocations.
inline constexpr std::size_t kCacheEntryOverheadBytes = 240;

class MemoryCache {
 public:
  explicit MemoryCache(std::size_t bytes_max);

  /// Null when absent.
  PayloadRef load(const PayloadName& name);
  /// Replaces an entry of the same name. A payload larger than a shard's share is not kept.
  void store(const PayloadName& name, PayloadRef payload);

  std::size_t bytes() const;  ///< overhead included
  std::size_t entries() const;
  std::size_t bytes_max() const { return shard_bytes_max_ * kShards; }

 private:
  static constexpr std::size_t kShards = 16;  // four bits of the hash

  /// Links of the list of use are pointers into the map, whose nodes do not move: one allocation an entry.
  struct Entry {
    PayloadRef payload;
    const PayloadName* name = nullptr;
    Entry* newer = nullptr;
    Entry* older = nullptr;
    std::size_t cost = 0;
  };
  struct Shard {
    mutable std::mutex mutex;
    std::unordered_map<PayloadName, Entry, PayloadNameHash> entries;
    Entry* newest = nullptr;
    Entry* oldest = nullptr;
    std::size_t bytes = 0;

    void link_newest(Entry& entry);
    void unlink(Entry& entry);
    void evict_oldest();
  };

  Shard& shard_of(const PayloadName& name);

  const std::size_t shard_bytes_max_;
  std::array<Shard, kShards> shards_;
};

}  // namespace talus::server
