#include "io/sqlite.hpp"

#include <sqlite3.h>

#include <array>
#include <utility>

#include "projection/error.hpp"

namespace thermovox {
namespace {

/// Readers wait for programs other than this one, which write in place.
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
      throw DataError(file_name + ": another process is writing it, expected it to finish: try again then");
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
      throw DataError(file_name + ": cannot be opened or written here (" + detail + ")");
    default:
      throw DataError(file_name + ": " + detail);
  }
}

bool isBeside(const std::filesystem::path& path, const char* ending) {
  std::error_code ignored;
  return std::filesystem::exists(path.string() + ending, ignored);
}

/// Whether the open file's header says that it is written with a write-ahead log (bytes 18 and 19 are 2).
/// Read through SQLite: to open the file once more and close it would drop SQLite's locks on it.
bool isInWalMode(sqlite3* database) {
  sqlite3_file* file = nullptr;
  std::array<char, 2> versions{};
  if (sqlite3_file_control(database, "main", SQLITE_FCNTL_FILE_POINTER, &file) != SQLITE_OK) return false;
  if (file == nullptr || file->pMethods == nullptr) return false;
  return file->pMethods->xRead(file, versions.data(), versions.size(), 18) == SQLITE_OK &&
         (versions[0] == 2 || versions[1] == 2);
}

int openFlags(const std::filesystem::path& path, SqlDatabase::Mode mode) {
  if (mode != SqlDatabase::Mode::read) return SQLITE_OPEN_READWRITE;
  // What a killed program that writes in place left beside the file has to be put back first.
  return isBeside(path, "-journal") || isBeside(path, "-wal") ? SQLITE_OPEN_READWRITE : SQLITE_OPEN_READONLY;
}

/// The file as a URI, which keeps names such as ":memory:" from having a meaning of their own.
std::string uriOf(const std::filesystem::path& path) {
  std::string uri = path.is_absolute() ? "file://" : "file:./";
  for (const char c : path.string()) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#') {
      uri += {'%', digits[byte >> 4], digits[byte & 15]};
    } else {
      uri += c;
    }
  }
  return uri;
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

SqlStatement& SqlStatement::bindReal(int parameter, double number) {
  check(sqlite3_bind_double(statement_.get(), parameter, number));
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

bool SqlStatement::isNull(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::int64_t SqlStatement::integer(int column) const {
  expectType(column, SQLITE_INTEGER, "a whole number");
  return sqlite3_column_int64(statement_.get(), column);
}

double SqlStatement::real(int column) const {
  expectType(column, SQLITE_FLOAT, "a number");
  return sqlite3_column_double(statement_.get(), column);
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
  // A file that nobody else sees needs no locks, and over NFS they would meet those of UnfinishedFile.
  open(uriOf(path) + (mode == Mode::build ? "?nolock=1" : ""), openFlags(path, mode));
  // A file that another program left in write-ahead mode, with nothing beside it, can only be read without
  // leaving something there when it is taken for immutable.
  if (mode == Mode::read && !isBeside(path, "-wal") && isInWalMode(database_.get()))
    open(uriOf(path) + "?immutable=1", SQLITE_OPEN_READONLY);
  sqlite3_busy_timeout(database_.get(), kBusyMilliseconds);
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  if (mode == Mode::build) {
    execute("PRAGMA journal_mode = MEMORY");
    execute("PRAGMA synchronous = OFF");
    execute("PRAGMA locking_mode = EXCLUSIVE");
  }
}

void SqlDatabase::open(const std::string& uri, int flags) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &database, flags | SQLITE_OPEN_URI, nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) fail(file_name_, database, code);
  sqlite3_extended_result_codes(database, 0);
}

bool SqlDatabase::tryLock() {
  sqlite3_busy_timeout(database_.get(), 0);
  // What another program writes with a log beside the file cannot be replaced while it has that open.
  int code = sqlite3_exec(database_.get(), "PRAGMA journal_mode = DELETE", nullptr, nullptr, nullptr);
  if (code == SQLITE_OK && isInWalMode(database_.get())) code = SQLITE_BUSY;
  if (code == SQLITE_OK) code = sqlite3_exec(database_.get(), "BEGIN IMMEDIATE", nullptr, nullptr, nullptr);
  if (code != SQLITE_OK && code != SQLITE_BUSY) fail(file_name_, database_.get(), code);
  sqlite3_busy_timeout(database_.get(), kBusyMilliseconds);
  return code == SQLITE_OK;
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

}  // namespace thermovox
