#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace thermovox {

/// One SQL statement with its parameters. Errors are DataErrors that name the database's file.
class SqlStatement {
 public:
  SqlStatement(sqlite3* database, std::string_view sql, std::string file_name);

  /// Parameters count from 1, in the order of their question marks.
  SqlStatement& bind(int parameter, std::int64_t number);
  SqlStatement& bindReal(int parameter, double number);
  SqlStatement& bindText(int parameter, std::string_view text);
  SqlStatement& bindBlob(int parameter, std::string_view bytes);

  /// Goes to the next row; false after the last.
  [[nodiscard]] bool step();
  /// Runs a statement that gives no rows, and makes it ready to be bound again.
  void run();
  void reset();

  [[nodiscard]] bool isNull(int column) const;
  /// Columns count from 0. A column of another type than asked for is a DataError.
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string text(int column) const;
  /// Valid until the next step().
  [[nodiscard]] std::string_view blob(int column) const;

 private:
  void check(int code) const;
  void expectType(int column, int type, const char* name) const;

  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };
  sqlite3* database_;
  std::string file_name_;
  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
};

/// An open SQLite database.
class SqlDatabase {
 public:
  enum class Mode {
    build,  ///< an empty file that nobody else sees and that is thrown away when it does not get finished
    read,   ///< an existing file; needs no right to write, and leaves nothing behind
    lock,   ///< an existing file, to keep others from writing it with tryLock()
  };
  /// `shown_name` stands for the file in messages.
  SqlDatabase(const std::filesystem::path& path, Mode mode, std::string shown_name);

  /// Keeps every other process from writing the file until this object goes; false, at once, while another
  /// one does so.
  [[nodiscard]] bool tryLock();

  void execute(const std::string& sql);
  [[nodiscard]] SqlStatement prepare(std::string_view sql) const;
  /// The one integer that the query gives, such as a pragma's.
  [[nodiscard]] std::int64_t integer(std::string_view sql) const;

 private:
  void open(const std::string& uri, int flags);

  struct Closer {
    void operator()(sqlite3* database) const;
  };
  std::string file_name_;
  std::unique_ptr<sqlite3, Closer> database_;
};

}  // namespace thermovox
