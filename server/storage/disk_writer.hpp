// The one connection that writes the cache's database: its tables, its bound, its batches. Owner: DiskCache, under its
// lock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>

#include "server/storage/entry.hpp"
#include "server/storage/sqlite.hpp"

namespace talus::server {

/// One entry to be put into its place; without `is_whole` only its time of use is renewed.
struct DiskWrite {
  std::int64_t place = 0;
  std::span<const std::byte> head;
  std::span<const std::byte> payload;
  bool is_whole = true;
};

class DiskWriter {
 public:
  struct Outcome {
    std::size_t stored = 0;
    std::size_t evicted = 0;
    std::size_t bytes = 0;  ///< of the database, free pages apart
  };

  /// Opens the file and makes its tables when it is new. A fault of corruption: not a database, or of another edition.
  static std::expected<DiskWriter, SqlFault> open(const std::string& path);

  /// All or, on a fault, nothing. Evicts what was longest unused until the batch fits below `bytes_max`, at most
  /// kEvictedPerBatch entries: a bound that was lowered is reached over several batches.
  std::expected<Outcome, SqlFault> commit(std::span<const DiskWrite> batch, std::int64_t now_s, std::size_t bytes_max);
  std::expected<std::size_t, SqlFault> bytes();

  static constexpr std::size_t kEvictedPerBatch = 4096;

 private:
  DiskWriter(Database database, Statement insert, Statement touch, Statement evict);
  std::expected<Outcome, SqlFault> write(std::span<const DiskWrite> batch, std::int64_t now_s, std::size_t bytes_max);
  std::expected<std::size_t, SqlFault> make_room(std::size_t bytes_max);

  Database database_;
  Statement insert_;
  Statement touch_;
  Statement evict_;
};

}  // namespace talus::server
