#include "server/storage/sqlite.hpp"

namespace talus::server {

namespace {

constexpr int kPrimaryCodeMask = 0xFF;  // extended codes keep theirs in the low byte

SqlFault fault_of(sqlite3* handle, int code) {
  const char* message = handle == nullptr ? sqlite3_errstr(code) : sqlite3_errmsg(handle);
  return {code & kPrimaryCodeMask, message};
}

}  // namespace

std::expected<Database, SqlFault> Database::open(const std::string& path, Mode mode) {
  const int access = mode == Mode::kReadOnly ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, access | SQLITE_OPEN_NOMUTEX, nullptr);
  Database database(handle);  // SQLite gives a handle to be closed even when it fails
  if (code != SQLITE_OK) return std::unexpected(fault_of(handle, code));
  return database;
}

std::expected<void, SqlFault> Database::execute(const char* sql) {
  const int code = sqlite3_exec(handle(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return std::unexpected(fault_of(handle(), code));
  return {};
}

std::expected<std::int64_t, SqlFault> Database::number(const char* sql) {
  auto statement = Statement::prepare(*this, sql);
  if (!statement) return std::unexpected(statement.error());
  const auto row = statement->step();
  if (!row) return std::unexpected(row.error());
  return *row ? statement->number(0) : 0;
}

SqlFault Database::fault() const {
  return fault_of(handle(), sqlite3_errcode(handle()));
}

std::expected<Statement, SqlFault> Statement::prepare(Database& database, const char* sql) {
  sqlite3_stmt* handle = nullptr;
  if (sqlite3_prepare_v2(database.handle(), sql, -1, &handle, nullptr) != SQLITE_OK) {
    return std::unexpected(database.fault());
  }
  return Statement(handle);
}

void Statement::bind(int parameter, std::span<const std::byte> bytes) {
  // A null pointer would be NULL, which is not an empty blob.
  const void* data = bytes.empty() ? "" : static_cast<const void*>(bytes.data());
  sqlite3_bind_blob64(handle_.get(), parameter, data, bytes.size(), SQLITE_STATIC);
}

std::expected<bool, SqlFault> Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return std::unexpected(fault_of(sqlite3_db_handle(handle_.get()), code));
}

std::span<const std::byte> Statement::bytes(int column) const {
  const void* data = sqlite3_column_blob(handle_.get(), column);
  return {static_cast<const std::byte*>(data), static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

void Statement::reset() {
  sqlite3_reset(handle_.get());
  sqlite3_clear_bindings(handle_.get());
}

}  // namespace talus::server
