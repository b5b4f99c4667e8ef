#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace thermovox {

/// What to do with an output that is already there.
enum class Existing { refuse, replace };

/// The path's ending in lower case, with its dot: files are told by it whatever its case.
[[nodiscard]] std::string endingOf(const std::filesystem::path& path);

/// Throws DataError when the folder that an output (a file or a folder) is to lie in does not exist.
void checkFolderOf(const std::filesystem::path& path);

/// Throws DataError when the output exists and is to be kept, or its folder does not exist. For verbs that
/// work for minutes before they write: ask first.
void checkOutput(const std::filesystem::path& path, Existing existing);

/// A file that appears whole or not at all: it is written without a name (beside its name where the file
/// system knows no such files), brought to the disk and put into place by commit(). Without commit() nothing
/// of it stays, even when the program is killed. Every write is checked; a full disk is a DataError that
/// names the file.
class AtomicFile {
 public:
  AtomicFile(std::filesystem::path path, Existing existing);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view text);
  void write(std::span<const std::byte> bytes);
  /// Brings what was written to the disk, still beside its name.
  void sync();
  void commit();

 private:
  void open();
  void link();
  void flush();
  void writeOut(std::string_view text);
  [[noreturn]] void fail(const char* action) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;  ///< empty while the file has no name at all
  Existing existing_;
  std::string buffer_;
  int descriptor_ = -1;
};

}  // namespace thermovox
