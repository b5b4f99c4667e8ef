#include "io/sqlite.hpp"

#include <sqlite3.h>

#include <utility>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr int kBusyMilliseconds = 2000;

/// The sentence for what SQLite found.
[[noreturn]] void fail(const std::string& file_name, sqlite3* database, int code) {
  const std::string detail = database ? sqlite3_errmsg(database) : sqlite3_errstr(code);
  switch (code & 0xFF) {
    case SQLITE_NOTADB:
      throw DataError(file_name + ": is not a station (no SQLite database)");
    case SQLITE_CORRUPT:
      throw DataError(file_name + ": is damaged or truncated (" + detail + ")");
    case SQLITE_FULL:
      throw DataError(file_name + ": cannot be written, the disk is full");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw DataError(file_name + ": another process is writing it, try again when that has finished");
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
      throw DataError(file_name + ": cannot be opened or written here (" + detail + ")");
    default:
      throw DataError(file_name + ": " + detail);
  }
}

}  // namespace

void SqlStatement::Finalizer::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqlStatement::SqlStatement(sqlite3* database, std::string_view sql, std::string file_name)
    : database_(database), file_name_(std::move(file_name)) {
  sqlite3_stmt* statement = nullptr;
  check(sqlite3_prepare_v2(database_, sql.data(), static_cast<int>(sql.size()), &statement, nullptr));
  statement_.reset(statement);
}

void SqlStatement::check(int code) const {
  if (code != SQLITE_OK) fail(file_name_, database_, code);
}

SqlStatement& SqlStatement::bind(int parameter, std::int64_t number) {
  check(sqlite3_bind_int64(statement_.get(), parameter, number));
  return *this;
}

SqlStatement& SqlStatement::bindText(int parameter, std::string_view text) {
  check(sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

SqlStatement& SqlStatement::bindBlob(int parameter, std::string_view bytes) {
  check(sqlite3_bind_blob64(statement_.get(), parameter, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
  return *this;
}

bool SqlStatement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) fail(file_name_, database_, code);
  return false;
}

void SqlStatement::run() {
  while (step()) continue;
  reset();
}

void SqlStatement::reset() {
  check(sqlite3_reset(statement_.get()));
}

void SqlStatement::expectType(int column, int type, const char* name) const {
  if (sqlite3_column_type(statement_.get(), column) == type) return;
  throw DataError(file_name_ + ": is damaged, its field " + sqlite3_column_name(statement_.get(), column) +
                  " holds something else, expected " + name);
}

std::int64_t SqlStatement::integer(int column) const {
  expectType(column, SQLITE_INTEGER, "a whole number");
  return sqlite3_column_int64(statement_.get(), column);
}

std::string SqlStatement::text(int column) const {
  expectType(column, SQLITE_TEXT, "text");
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::string_view SqlStatement::blob(int column) const {
  expectType(column, SQLITE_BLOB, "bytes");
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void SqlDatabase::Closer::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

SqlDatabase::SqlDatabase(const std::filesystem::path& path, Mode mode, std::string shown_name)
    : file_name_(std::move(shown_name)) {
  const int flags = SQLITE_OPEN_READWRITE | (mode == Mode::create ? SQLITE_OPEN_CREATE : 0);
  // "./" keeps names that begin with "file:" or ":memory:" from having a meaning of their own.
  const std::string name = path.is_absolute() ? path.string() : "./" + path.string();
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &database, flags, nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) fail(file_name_, database, code);
  sqlite3_extended_result_codes(database, 0);
  sqlite3_busy_timeout(database, kBusyMilliseconds);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
}

void SqlDatabase::execute(const std::string& sql) {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(file_name_, database_.get(), code);
}

SqlStatement SqlDatabase::prepare(std::string_view sql) const {
  return {database_.get(), sql, file_name_};
}

std::int64_t SqlDatabase::integer(std::string_view sql) const {
  SqlStatement query = prepare(sql);
  if (!query.step()) throw DataError(file_name_ + ": is damaged, a number is missing");
  return query.integer(0);
}

SqlTransaction::SqlTransaction(SqlDatabase& database) : database_(database) {
  database_.execute("BEGIN IMMEDIATE");
}

SqlTransaction::~SqlTransaction() {
  if (!open_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const DataError&) {
    // SQLite has rolled back on its own already.
  }
  try {
    // After a failed write (a full disk) the pages in the file are put back at the next reading only; until
    // then the journal beside it is a part of the database.
    (void)database_.integer("SELECT count(*) FROM sqlite_master");
  } catch (const DataError&) {
    // Not now, then; whoever opens the file next does it.
  }
}

void SqlTransaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace thermovox
