// Payloads on the disk, by the names that this process and the next agree on.
//
// A PayloadName is good for one process: it counts worlds. On the disk a payload goes by what decides its bytes: world
// hash, generator version, revision and edition of the format (its ETag), and key. So a file may serve other worlds,
// and other versions of this program, and none is ever given another's bytes. Any thread, but see `load`.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/cache/payload.hpp"
#include "server/storage/disk_cache.hpp"
#include "server/world/world.hpp"

namespace talus::server {

class StoredChunks {
 public:
  /// Remembers nothing until `attach`. `worlds` must outlive it.
  explicit StoredChunks(const Worlds& worlds) : worlds_(worlds) {}

  /// Before the first load or store.
  void attach(std::unique_ptr<DiskCache> disk) { disk_ = std::move(disk); }
  const DiskCache* disk() const { return disk_.get(); }

  /// Reads the disk. `thread` is the index of the calling pool thread.
  std::optional<ChunkPayload> load(const PayloadName& name, std::size_t thread);
  void store(const PayloadName& name, const PayloadRef& payload, DiskCache::Commit commit);
  void flush();

 private:
  std::optional<std::string> disk_name(const PayloadName& name) const;

  const Worlds& worlds_;
  std::unique_ptr<DiskCache> disk_;
};

}  // namespace talus::server
