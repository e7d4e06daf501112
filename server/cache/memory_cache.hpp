// Encoded chunks in memory, bounded in bytes. Any thread.
//
// Problem: most chunks are asked for once, by somebody flying over or scanning, and with an order of last use each of
// them pushes out one that many ask for. Answer: a newcomer waits in a short queue, a tenth of the bytes; only if it is
// asked for again there does it come into the long one, where what is used stays. Of what left the short queue the name
// is remembered a while: whoever comes back after all goes to the long queue at once.
//
// Sharded by hash, each shard with its own lock, queues and share of the bytes, so network threads that answer from
// memory do not wait for one another. A hit moves nothing: it counts. A payload that was handed out lives on in its
// holders after it is evicted.
//
// Based on: J. Yang et al., "FIFO queues are all you need for cache eviction" (S3-FIFO), SOSP 2023; here bounded in
// bytes, and the ghosts are a table in which a later name takes an earlier one's slot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "server/cache/payload.hpp"

namespace talus::server {

/// What an entry costs beside its payload's bytes: map node 104 B, bucket 8 B, payload with its control block 56 B, its
/// share of the ghosts 8 B, and malloc's 16 B and rounding for each of the three allocations.
inline constexpr std::size_t kCacheEntryOverheadBytes = 248;

class MemoryCache {
 public:
  explicit MemoryCache(std::size_t bytes_max);

  /// Null when absent.
  PayloadRef load(const PayloadName& name);
  /// Replaces an entry of the same name. A payload larger than a shard's share is not kept.
  void store(const PayloadName& name, PayloadRef payload);

  /// What has happened since the start.
  struct Totals {
    std::uint64_t hits = 0;
    std::uint64_t misses = 0;
    std::uint64_t stored = 0;
    std::uint64_t evicted = 0;   ///< pushed out of either queue
    std::uint64_t recalled = 0;  ///< stored again soon after it was pushed out: straight to the long queue
  };
  Totals totals() const;

  std::size_t bytes() const;  ///< overhead included
  std::size_t entries() const;
  std::size_t bytes_max() const { return shard_bytes_max_ * kShards; }

 private:
  static constexpr std::size_t kShards = 16;  // four bits of the hash

  /// Links of the queues are pointers into the map, whose nodes do not move: one allocation an entry.
  struct Entry {
    PayloadRef payload;
    const PayloadName* name = nullptr;
    Entry* newer = nullptr;
    Entry* older = nullptr;
    std::uint32_t cost = 0;
    std::uint8_t uses = 0;  ///< since it came into its queue, at most kUsesMax
    bool is_main = false;   ///< in the long queue
  };
  struct Queue {
    Entry* newest = nullptr;
    Entry* oldest = nullptr;
    std::size_t bytes = 0;

    void push(Entry& entry);
    void unlink(Entry& entry);
  };
  /// A name whose hash is known: the map does not work it out a second time.
  struct HashedName {
    const PayloadName& name;
    std::size_t hash;
  };
  struct NameHash : PayloadNameHash {
    using is_transparent = void;
    using PayloadNameHash::operator();
    std::size_t operator()(const HashedName& hashed) const noexcept { return hashed.hash; }
  };
  struct NameEqual : std::equal_to<PayloadName> {
    using is_transparent = void;
    using std::equal_to<PayloadName>::operator();
    bool operator()(const HashedName& a, const PayloadName& b) const { return a.name == b; }
  };
  struct Shard {
    mutable std::mutex mutex;
    std::unordered_map<PayloadName, Entry, NameHash, NameEqual> entries;
    Queue small;
    Queue main;
    Totals totals;
    std::vector<std::uint64_t> ghosts;  ///< hashes of names that left the short queue unused

    std::size_t bytes() const { return small.bytes + main.bytes; }
    std::uint64_t& ghost_of(std::uint64_t hash) { return ghosts[hash % ghosts.size()]; }
    void evict_one(std::size_t bytes_max);
    bool evict_from_small();
    bool evict_from_main();
    void forget(Entry& entry);
  };

  Shard& shard_of(std::uint64_t hash);

  const std::size_t shard_bytes_max_;
  std::array<Shard, kShards> shards_;
};

}  // namespace talus::server
