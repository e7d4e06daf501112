#include "server/storage/disk_writer.hpp"

#include <fmt/format.h>

#include <utility>

namespace talus::server {

namespace {

/// Raised when the tables change. A file of another edition is begun anew.
constexpr std::int64_t kTablesEdition = 1;

// Incremental vacuum gives pages back when the bound is lowered. NORMAL syncs at checkpoints only: a crash of the
// machine loses the newest entries, never the file. No mmap: a truncated file would end the process.
constexpr const char* kSetUp =
    "PRAGMA auto_vacuum=INCREMENTAL; PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL; PRAGMA mmap_size=0;"
    "PRAGMA wal_autocheckpoint=1000; PRAGMA journal_size_limit=8388608; PRAGMA cache_size=-2048;";
constexpr const char* kTables =
    "CREATE TABLE entry (place INTEGER PRIMARY KEY, used INTEGER NOT NULL, head BLOB NOT NULL, payload BLOB NOT NULL);"
    "CREATE INDEX entry_by_use ON entry (used);";

constexpr std::int64_t kEvictedAtOnce = 64;

SqlFault other_edition() {
  return {SQLITE_NOTADB, "tables of another edition"};
}

}  // namespace

DiskWriter::DiskWriter(Database database, Statement insert, Statement touch, Statement evict)
    : database_(std::move(database)), insert_(std::move(insert)), touch_(std::move(touch)), evict_(std::move(evict)) {}

std::expected<DiskWriter, SqlFault> DiskWriter::open(const std::string& path) {
  auto database = Database::open(path, Database::Mode::kReadWrite);
  if (!database) return std::unexpected(database.error());
  if (const auto done = database->execute(kSetUp); !done) return std::unexpected(done.error());
  const auto edition = database->number("PRAGMA user_version");
  if (!edition) return std::unexpected(edition.error());
  const auto tables = database->number("SELECT count(*) FROM sqlite_schema");
  if (!tables) return std::unexpected(tables.error());
  if (*tables == 0) {
    const std::string sql = fmt::format("BEGIN; {} PRAGMA user_version={}; COMMIT;", kTables, kTablesEdition);
    if (const auto done = database->execute(sql.c_str()); !done) return std::unexpected(done.error());
  } else if (*edition != kTablesEdition) {
    return std::unexpected(other_edition());
  }
  auto insert = Statement::prepare(*database, "INSERT OR REPLACE INTO entry VALUES (?1, ?2, ?3, ?4)");
  if (!insert) return std::unexpected(insert.error());
  auto touch = Statement::prepare(*database, "UPDATE entry SET used = ?2 WHERE place = ?1");
  if (!touch) return std::unexpected(touch.error());
  auto evict = Statement::prepare(*database,
                                  "DELETE FROM entry WHERE place IN (SELECT place FROM entry ORDER BY used LIMIT ?1)");
  if (!evict) return std::unexpected(evict.error());
  return DiskWriter(std::move(*database), std::move(*insert), std::move(*touch), std::move(*evict));
}

std::expected<std::size_t, SqlFault> DiskWriter::bytes() {
  std::int64_t values[3]{};
  constexpr const char* kSql[3]{"PRAGMA page_count", "PRAGMA freelist_count", "PRAGMA page_size"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = database_.number(kSql[i]);
    if (!value) return std::unexpected(value.error());
    values[i] = *value;
  }
  return static_cast<std::size_t>((values[0] - values[1]) * values[2]);
}

std::expected<DiskWriter::Outcome, SqlFault> DiskWriter::commit(std::span<const DiskWrite> batch, std::int64_t now_s,
                                                                std::size_t bytes_max) {
  if (const auto begun = database_.execute("BEGIN IMMEDIATE"); !begun) return std::unexpected(begun.error());
  auto outcome = write(batch, now_s, bytes_max);
  if (outcome) {
    if (const auto done = database_.execute("COMMIT"); !done) outcome = std::unexpected(done.error());
  }
  if (!outcome) (void)database_.execute("ROLLBACK");  // there may be nothing to roll back any more
  return outcome;
}

std::expected<DiskWriter::Outcome, SqlFault> DiskWriter::write(std::span<const DiskWrite> batch, std::int64_t now_s,
                                                               std::size_t bytes_max) {
  Outcome outcome;
  for (const DiskWrite& one : batch) {
    Statement& statement = one.is_whole ? insert_ : touch_;
    statement.bind(1, one.place);
    statement.bind(2, now_s);
    if (one.is_whole) {
      statement.bind(3, one.head);
      statement.bind(4, one.payload);
    }
    const auto row = statement.step();
    statement.reset();
    if (!row) return std::unexpected(row.error());
    outcome.stored += one.is_whole ? 1 : 0;
  }
  const auto evicted = make_room(bytes_max);
  if (!evicted) return std::unexpected(evicted.error());
  outcome.evicted = *evicted;
  const auto left = bytes();
  if (!left) return std::unexpected(left.error());
  outcome.bytes = *left;
  return outcome;
}

std::expected<std::size_t, SqlFault> DiskWriter::make_room(std::size_t bytes_max) {
  std::size_t evicted = 0;
  while (evicted < kEvictedPerBatch) {
    const auto used = bytes();
    if (!used) return std::unexpected(used.error());
    if (*used <= bytes_max) break;
    evict_.bind(1, kEvictedAtOnce);
    const auto row = evict_.step();
    evict_.reset();
    if (!row) return std::unexpected(row.error());
    const auto changes = static_cast<std::size_t>(sqlite3_changes(database_.handle()));
    if (changes == 0) break;
    evicted += changes;
  }
  if (evicted != 0) {
    // Pages that eviction freed beyond what the next batches need go back to the file system.
    if (const auto done = database_.execute("PRAGMA incremental_vacuum(1024)"); !done) {
      return std::unexpected(done.error());
    }
  }
  return evicted;
}

}  // namespace talus::server
