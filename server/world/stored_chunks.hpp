// Payloads on the disk, by the names that this process and the next agree on.
//
// A PayloadName is good for one process: it counts worlds. On the disk a payload goes by what decides its bytes: world
// hash, generator version, revision and edition of the format (its ETag), and key. So a file may serve other worlds,
// and other versions of this program, and none is ever given another's bytes. Any thread, but see `load`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/world/manifest.hpp"
#include "server/cache/payload.hpp"
#include "server/storage/disk_cache.hpp"
#include "server/world/world.hpp"

namespace talus::server {

class StoredChunks {
 public:
  /// Remembers nothing until `attach`. `worlds` must outlive it. What another version of the generator has made is as
  /// if it were not there.
  explicit StoredChunks(const Worlds& worlds, std::uint32_t generator_version = kGeneratorVersion)
      : worlds_(worlds), generator_version_(generator_version) {}

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
  const std::uint32_t generator_version_;
  std::unique_ptr<DiskCache> disk_;
};

}  // namespace talus::server
