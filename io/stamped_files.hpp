#pragma once

#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>

#include "io/csv.hpp"

namespace thermovox {

/// A row of thermal.csv (`timestamp,file[,page]`), visible.csv or clouds.csv (`timestamp,file`).
struct StampedFile {
  Time stamp;
  std::filesystem::path file;  ///< beside the list's own folder, where the row does not give a whole path
  std::string written;         ///< the file as the row names it
  int page = 0;                ///< image of a file with several, from 0
  std::string place;           ///< "thermal.csv:3", for messages
};

/// Reads such a list row by row.
class StampedFiles {
 public:
  /// Whether a row may name a page of its file.
  enum class Pages { allow, refuse };

  /// `folder` is what the rows' files are relative to; `name` stands for the list in messages.
  StampedFiles(std::unique_ptr<std::istream> list, std::string name, std::filesystem::path folder,
               Pages pages);

  /// The next row; nullopt at the end. Throws DataError naming file and line: stamps that do not ascend, no
  /// file, a page where none may be, or one that is no whole number from 0.
  [[nodiscard]] std::optional<StampedFile> next();

 private:
  StampedRows rows_;
  std::filesystem::path folder_;
  Pages pages_;
};

}  // namespace thermovox
