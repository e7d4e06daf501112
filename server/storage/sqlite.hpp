// The little of SQLite that storage uses: a connection and a prepared statement, closed by their owners. A connection
// and its statements are used by one thread at a time.
#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <span>
#include <string>

namespace talus::server {

/// What SQLite says about a failure: its primary code and a sentence.
struct SqlFault {
  int code = SQLITE_ERROR;
  std::string message;

  /// The file is no database any more, or its inside contradicts itself: nothing in it can be relied on.
  bool is_corruption() const { return code == SQLITE_CORRUPT || code == SQLITE_NOTADB; }
};

class Database {
 public:
  enum class Mode : std::uint8_t { kReadWrite, kReadOnly };

  /// Creates the file when it may be written. SQLite's own locks are off: see above.
  static std::expected<Database, SqlFault> open(const std::string& path, Mode mode);

  std::expected<void, SqlFault> execute(const char* sql);
  /// The first column of the first row.
  std::expected<std::int64_t, SqlFault> number(const char* sql);
  SqlFault fault() const;
  sqlite3* handle() const { return handle_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };
  explicit Database(sqlite3* handle) : handle_(handle) {}
  std::unique_ptr<sqlite3, Close> handle_;
};

/// Bound, stepped, and reset: one run after another. Must not outlive its database.
class Statement {
 public:
  static std::expected<Statement, SqlFault> prepare(Database& database, const char* sql);

  /// Parameters are numbered from 1. Bytes must stay until `reset`.
  void bind(int parameter, std::int64_t value) { sqlite3_bind_int64(handle_.get(), parameter, value); }
  void bind(int parameter, std::span<const std::byte> bytes);
  /// True: a row; false: the end.
  std::expected<bool, SqlFault> step();
  /// Of the present row, until the next step or reset.
  std::int64_t number(int column) const { return sqlite3_column_int64(handle_.get(), column); }
  std::span<const std::byte> bytes(int column) const;
  void reset();

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
  };
  explicit Statement(sqlite3_stmt* handle) : handle_(handle) {}
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

}  // namespace talus::server
