#include "io/stamped_files.hpp"

#include <utility>

#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {

StampedFiles::StampedFiles(std::unique_ptr<std::istream> list, std::string name, std::filesystem::path folder,
                           Pages pages)
    : rows_(CsvReader(std::move(list), std::move(name))), folder_(std::move(folder)), pages_(pages) {}

std::optional<StampedFile> StampedFiles::next() {
  if (!rows_.next()) return std::nullopt;
  const auto& fields = rows_.row().fields();
  const bool paged = pages_ == Pages::allow;
  if (fields.size() < 2 || fields.size() > (paged ? 3U : 2U)) {
    throw DataError(rows_.row().place() + ": has " + std::to_string(fields.size()) +
                    " field(s), expected timestamp,file" + (paged ? "[,page]" : ""));
  }
  if (fields[1].empty()) throw DataError(rows_.row().place() + ": names no file, expected timestamp,file");
  StampedFile row{.stamp = rows_.stamp(),
                  .file = folder_ / fields[1],
                  .written = std::string(fields[1]),
                  .place = rows_.row().place()};
  if (row.written.find('\0') != std::string::npos)
    throw DataError(row.place + ": the name of the file is damaged");
  if (fields.size() == 3) {
    const std::optional<int> page = parseInteger(fields[2]);
    if (!page || *page < 0) {
      throw DataError(row.place + ": found page " + inQuotes(fields[2]) + ", expected a whole number from 0");
    }
    row.page = *page;
  }
  return row;
}

}  // namespace thermovox
