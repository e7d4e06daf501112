#include "server/storage/disk_cache.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/base/check.hpp"
#include "server/observe/log.hpp"
#include "server/storage/disk_writer.hpp"

namespace talus::server {

namespace {

/// A commit costs about the same for one entry as for sixty-four. Renewals alone make a batch of their own more seldom:
/// nothing is lost with them.
constexpr std::size_t kBatchEntries = 64;
constexpr std::size_t kBatchRenewals = 1024;
constexpr std::size_t kNever = ~std::size_t{0};
/// What may wait while a batch is being written; beyond it new entries are shed.
constexpr std::size_t kPendingBytesMax = 16 * 1024 * 1024;
/// What an entry without payload costs in the queue.
constexpr std::size_t kPendingOverheadBytes = 128;
/// A time of use is renewed when it is older than this: renewing writes the entry once more.
constexpr std::int64_t kRenewAfterS = 3600;

constexpr const char* kFileName = "chunks.sqlite";
constexpr const char* kSelect = "SELECT used, head, payload FROM entry WHERE place = ?1";

std::string file_in(const std::string& folder) {
  return folder + "/" + kFileName;
}

void remove_file(const std::string& folder) {
  for (const char* suffix : {"", "-wal", "-shm"}) ::unlink((file_in(folder) + suffix).c_str());
}

std::string reason_of(int error) {
  return std::generic_category().message(error);
}

/// The descriptor, locked for this process, or why it is not.
std::expected<int, std::string> lock_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return std::unexpected(folder + ": " + error.message());
  const std::string path = folder + "/lock";
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor < 0) return std::unexpected(path + ": " + reason_of(errno));
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  const int reason = errno;
  ::close(descriptor);
  return std::unexpected(reason == EWOULDBLOCK ? folder + ": another server uses this folder"
                                               : path + ": " + reason_of(reason));
}

}  // namespace

struct DiskCache::Reader {
  Database database;
  Statement select;

  static std::expected<std::unique_ptr<Reader>, SqlFault> open(const std::string& path) {
    auto database = Database::open(path, Database::Mode::kReadOnly);
    if (!database) return std::unexpected(database.error());
    // The writer alone checkpoints; pages are kept by the system, not by every thread.
    sqlite3_db_config(database->handle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    if (const auto done = database->execute("PRAGMA mmap_size=0; PRAGMA cache_size=-256;"); !done) {
      return std::unexpected(done.error());
    }
    auto select = Statement::prepare(*database, kSelect);
    if (!select) return std::unexpected(select.error());
    return std::make_unique<Reader>(Reader{std::move(*database), std::move(*select)});
  }
};

DiskCache::DiskCache(DiskCacheOptions options, const Clock& clock, Metrics& metrics)
    : options_(std::move(options)), clock_(clock), metrics_(metrics) {}

std::expected<std::unique_ptr<DiskCache>, std::string> DiskCache::open(const DiskCacheOptions& options,
                                                                       const Clock& clock, Metrics& metrics) {
  const auto lock = lock_folder(options.folder);
  if (!lock) return std::unexpected(lock.error());
  std::unique_ptr<DiskCache> cache(new DiskCache(options, clock, metrics));
  cache->lock_ = *lock;
  const std::string path = file_in(options.folder);
  auto writer = DiskWriter::open(path);
  if (!writer && writer.error().is_corruption()) {
    log(LogLevel::kWarning, "disk cache begun anew", {{"file", path}, {"fault", writer.error().message}});
    metrics.add(Count::kDiskFault);
    remove_file(options.folder);
    writer = DiskWriter::open(path);
  }
  if (!writer) return std::unexpected(path + ": " + writer.error().message);
  cache->writer_ = std::make_unique<DiskWriter>(std::move(*writer));
  cache->bytes_.store(cache->writer_->bytes().value_or(0), std::memory_order_relaxed);
  for (std::size_t i = 0; i < options.readers; ++i) {
    auto reader = Reader::open(path);
    if (!reader) return std::unexpected(path + ": " + reader.error().message);
    cache->readers_.push_back(std::move(*reader));
  }
  return cache;
}

DiskCache::~DiskCache() {
  if (writer_ != nullptr) flush();
  readers_.clear();
  writer_.reset();  // the last to close: it checkpoints
  if (lock_ >= 0) ::close(lock_);
}

std::optional<DiskCache::Loaded> DiskCache::load(std::string_view name, std::size_t reader) {
  TALUS_CHECK(reader < readers_.size());
  if (!is_usable_.load(std::memory_order_relaxed)) return std::nullopt;
  const Instant start = clock_.now();
  const std::int64_t place = entry_place(name);
  Statement& select = readers_[reader]->select;
  select.bind(1, place);
  const auto row = select.step();
  std::optional<Loaded> loaded;
  if (!row) {
    const SqlFault& fault = row.error();
    on_fault("load", fault.code, fault.message, fault.is_corruption());
  } else if (!*row) {
    metrics_.add(Count::kDiskMiss);
  } else if (const auto kind = decode_entry(name, select.bytes(1), select.bytes(2)); !kind) {
    // It is made again, and then takes the place of this one.
    metrics_.add(Count::kDiskBad);
  } else {
    const auto payload = select.bytes(2);
    loaded = Loaded{*kind, {payload.begin(), payload.end()}};
    metrics_.add(Count::kDiskHit);
    if (clock_.unix_seconds() - select.number(0) > kRenewAfterS) push({place, {}, nullptr}, kBatchRenewals);
  }
  select.reset();
  metrics_.record(Hop::kLoadStored, clock_.now() - start);
  return loaded;
}

void DiskCache::store(std::string_view name, std::uint8_t kind, StoredBytes bytes, Commit commit) {
  if (!is_usable_.load(std::memory_order_relaxed) || bytes->size() > kEntryPayloadBytesMax) return;
  Pending pending{entry_place(name), encode_entry_head(name, kind, *bytes), std::move(bytes)};
  push(std::move(pending), commit == Commit::kNow ? kBatchEntries : kNever);
}

void DiskCache::push(Pending pending, std::size_t commit_at) {
  const std::size_t cost = kPendingOverheadBytes + (pending.bytes == nullptr ? 0 : pending.bytes->size());
  {
    const std::lock_guard lock(pending_mutex_);
    if (pending_bytes_ + cost > kPendingBytesMax) return metrics_.add(Count::kDiskShed);
    pending_bytes_ += cost;
    pending_.push_back(std::move(pending));
    if (pending_.size() < commit_at) return;
  }
  // Whoever finds the writer busy leaves its batch to the next.
  const std::unique_lock writing(writer_mutex_, std::try_to_lock);
  if (writing) commit_pending();
}

void DiskCache::flush() {
  const std::lock_guard writing(writer_mutex_);
  commit_pending();
}

/// Under writer_mutex_.
void DiskCache::commit_pending() {
  std::vector<Pending> taken;
  {
    const std::lock_guard lock(pending_mutex_);
    taken.swap(pending_);
    pending_bytes_ = 0;
  }
  if (taken.empty() || !is_usable_.load(std::memory_order_relaxed)) return;
  const Instant start = clock_.now();
  std::vector<DiskWrite> batch;
  batch.reserve(taken.size());
  for (const Pending& one : taken) {
    if (one.bytes == nullptr) {
      batch.push_back({one.place, {}, {}, false});
    } else {
      batch.push_back({one.place, one.head, *one.bytes, true});
    }
  }
  const auto outcome = writer_->commit(batch, clock_.unix_seconds(), options_.bytes_max);
  metrics_.record(Hop::kCommitStored, clock_.now() - start);
  if (!outcome) {
    const SqlFault& fault = outcome.error();
    return on_fault("commit", fault.code, fault.message, fault.is_corruption());
  }
  metrics_.add(Count::kDiskStored, outcome->stored);
  metrics_.add(Count::kDiskEvicted, outcome->evicted);
  bytes_.store(outcome->bytes, std::memory_order_relaxed);
}

/// A full disk may have room again later; a file that contradicts itself is given up, and begun anew at the next start.
void DiskCache::on_fault(std::string_view doing, int code, std::string_view message, bool is_corruption) {
  metrics_.add(Count::kDiskFault);
  if (is_corruption && is_usable_.exchange(false)) remove_file(options_.folder);
  if (is_fault_logged_.exchange(true)) return;
  log(LogLevel::kError, "disk cache fault",
      {{"doing", doing}, {"code", std::int64_t{code}}, {"fault", message}, {"is_given_up", is_corruption}});
}

std::size_t DiskCache::pending_bytes() const {
  const std::lock_guard lock(pending_mutex_);
  return pending_bytes_;
}

}  // namespace talus::server
