#include "io/csv.hpp"

#include <utility>

#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool beginsWithLetter(std::string_view text) {
  return !text.empty() && ((text[0] >= 'a' && text[0] <= 'z') || (text[0] >= 'A' && text[0] <= 'Z'));
}

void splitInto(std::vector<std::string_view>& fields, std::string_view line) {
  fields.clear();
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    fields.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return;
    begin = comma + 1;
  }
}

}  // namespace

CsvReader::CsvReader(std::unique_ptr<std::istream> stream, std::string name, Header header)
    : stream_(std::move(stream)), name_(std::move(name)), header_possible_(header == Header::pass_over) {}

bool CsvReader::next() {
  while (std::getline(*stream_, line_)) {
    ++line_number_;
    std::string_view line = line_;
    if (line_number_ == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    line = trimmed(line);
    if (line.empty()) continue;
    if (std::exchange(header_possible_, false) && beginsWithLetter(line)) continue;
    splitInto(fields_, line);
    return true;
  }
  if (stream_->bad()) throw DataError(place() + ": reading failed");
  fields_.clear();
  return false;
}

Time CsvReader::stamp(std::size_t field) const {
  const std::optional<Time> stamp = parseTime(fields_.at(field));
  if (!stamp) {
    throw DataError(place() + ": found " + inQuotes(fields_[field]) +
                    ", expected a timestamp in decimal seconds");
  }
  return *stamp;
}

double CsvReader::number(std::size_t field) const {
  const std::optional<double> number = parseNumber(fields_.at(field));
  if (!number) {
    throw DataError(place() + ": found " + inQuotes(fields_[field]) + " as field " +
                    std::to_string(field + 1) + ", expected a number");
  }
  return *number;
}

std::string CsvReader::place() const {
  return name_ + ":" + std::to_string(line_number_);
}

bool StampedRows::next() {
  if (!csv_.next()) return false;
  const Time stamp = csv_.stamp(0);
  if (!first_ && stamp <= stamp_) {
    throw DataError(csv_.place() + ": timestamp " + formatTime(stamp) + " follows " + formatTime(stamp_) +
                    ", expected ascending timestamps");
  }
  stamp_ = stamp;
  first_ = false;
  return true;
}

}  // namespace thermovox
