// Payloads on the disk: what a world has cost once survives the process, and is served again byte for byte.
//
// Problem: a restart forgets everything, and the first view afterwards costs seconds of processors. Answer: one SQLite
// file of entries that prove themselves (entry.hpp). It is a cache: it may be deleted whenever one likes, a bad entry
// is a miss, and a file that contradicts itself is thrown away whole.
//
// Reading blocks on the disk, so it is done by pool threads, each with a connection of its own. Writing is collected
// and committed in batches by the pool thread that completes one, after its chunk was published; meanwhile the others
// go on. One connection writes and checkpoints. What was not committed when the process dies is only made again.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/observe/metrics.hpp"
#include "server/schedule/clock.hpp"
#include "server/storage/entry.hpp"

namespace talus::server {

class DiskWriter;

struct DiskCacheOptions {
  std::string folder;
  std::size_t bytes_max = 0;  ///< of the database; its log adds at most about 8 MiB
  std::size_t readers = 1;    ///< threads that load
};

/// Bytes somebody shares with the cache until they are on the disk.
using StoredBytes = std::shared_ptr<const std::vector<std::byte>>;

class DiskCache {
 public:
  struct Loaded {
    std::uint8_t kind = 0;
    std::vector<std::byte> bytes;
  };

  /// Makes folder and file, or begins anew when the file is not one of ours. The error is for the operator: no such
  /// place, not ours to write, or another server's.
  static std::expected<std::unique_ptr<DiskCache>, std::string> open(const DiskCacheOptions& options,
                                                                     const Clock& clock, Metrics& metrics);
  /// Commits what is pending. Nobody may be loading or storing.
  ~DiskCache();
  DiskCache(const DiskCache&) = delete;
  DiskCache& operator=(const DiskCache&) = delete;

  /// What was stored under `name`, or nothing. `reader` is below `readers`; no two calls with the same at once.
  std::optional<Loaded> load(std::string_view name, std::size_t reader);
  enum class Commit : std::uint8_t {
    kNow,   ///< a batch that is complete is committed here, which takes milliseconds
    kLater  ///< by whoever stores next with kNow, or flushes
  };
  /// Remembers a payload of at most kEntryPayloadBytesMax, or not: when more is pending than the disk takes, it is
  /// shed. Any thread.
  void store(std::string_view name, std::uint8_t kind, StoredBytes bytes, Commit commit = Commit::kNow);
  /// Commits what is pending. Any thread.
  void flush();

  std::size_t bytes() const { return bytes_.load(std::memory_order_relaxed); }  ///< as of the last commit
  std::size_t bytes_max() const { return options_.bytes_max; }
  std::size_t pending_bytes() const;

 private:
  struct Reader;

  struct Pending {
    std::int64_t place = 0;
    EntryHead head{};
    StoredBytes bytes;  ///< null: only the time of use is renewed
  };

  DiskCache(DiskCacheOptions options, const Clock& clock, Metrics& metrics);
  void push(Pending pending, std::size_t commit_at);
  void commit_pending();
  void on_fault(std::string_view doing, int code, std::string_view message, bool is_corruption);

  const DiskCacheOptions options_;
  const Clock& clock_;
  Metrics& metrics_;
  int lock_ = -1;  ///< descriptor of the lock file: one server a folder
  std::vector<std::unique_ptr<Reader>> readers_;

  mutable std::mutex pending_mutex_;
  std::vector<Pending> pending_;
  std::size_t pending_bytes_ = 0;

  std::mutex writer_mutex_;
  std::unique_ptr<DiskWriter> writer_;

  std::atomic<std::size_t> bytes_{0};
  std::atomic<bool> is_usable_{true};
  std::atomic<bool> is_fault_logged_{false};
};

}  // namespace talus::server
