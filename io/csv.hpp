#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "projection/time.hpp"

namespace thermovox {

/// Reads a comma-separated file row by row and holds one row at a time. Blank lines and one header row (a
/// first row that begins with a letter) are passed over; blanks around fields and CRLF do not matter. There
/// is no quoting.
class CsvReader {
 public:
  /// What is done with a first row that begins with a letter: where rows begin with names, it may be none.
  enum class Header { pass_over, keep };

  /// `name` stands for the stream in messages.
  CsvReader(std::unique_ptr<std::istream> stream, std::string name, Header header = Header::pass_over);

  /// Goes to the next row; false at the end. Throws DataError when the stream breaks.
  [[nodiscard]] bool next();

  /// The fields of the row; they live until the next call of next().
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }

  /// Field as a stamp, to the nanosecond, or as a number (inf and nan too). Throws DataError naming file,
  /// line and field.
  [[nodiscard]] Time stamp(std::size_t field) const;
  [[nodiscard]] double number(std::size_t field) const;

  /// "beam.csv:17", for messages about the current row.
  [[nodiscard]] std::string place() const;
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::unique_ptr<std::istream> stream_;
  std::string name_;
  std::string line_;
  std::size_t line_number_ = 0;
  bool header_possible_;
  std::vector<std::string_view> fields_;
};

/// A CSV file whose rows begin with a stamp: it sees to it that the clock only runs forwards.
class StampedRows {
 public:
  explicit StampedRows(CsvReader csv) : csv_(std::move(csv)) {}

  /// Goes to the next row; false at the end. Throws DataError naming file and line when the first field is no
  /// stamp or not later than that of the row before.
  [[nodiscard]] bool next();
  [[nodiscard]] Time stamp() const { return stamp_; }
  [[nodiscard]] const CsvReader& row() const { return csv_; }

 private:
  CsvReader csv_;
  Time stamp_;
  bool first_ = true;
};

}  // namespace thermovox
