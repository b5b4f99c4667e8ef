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

/// Throws DataError when the output exists and is to be kept, or its folder does not exist. For verbs that
/// work for minutes before they write: ask first.
void checkOutput(const std::filesystem::path& path, Existing existing);

/// A file that appears whole or not at all: it is written beside its name, brought to the disk and renamed
/// into place by commit(). Without commit() the destructor removes what was written. Every write is checked;
/// a full disk is a DataError that names the file.
class AtomicFile {
 public:
  AtomicFile(std::filesystem::path path, Existing existing);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view text);
  void write(std::span<const std::byte> bytes);
  /// Overwrites bytes that were written before (a count in a header that is known at the end).
  void rewrite(std::uint64_t offset, std::string_view text);
  /// Brings what was written to the disk, still beside its name.
  void sync();
  void commit();

  /// Where the bytes are until commit(): for libraries that write files by name.
  [[nodiscard]] const std::filesystem::path& temporaryPath() const { return temporary_; }

 private:
  void flush();
  void writeOut(std::string_view text);
  [[noreturn]] void fail(const char* action) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  Existing existing_;
  std::string buffer_;
  int descriptor_ = -1;
};

}  // namespace thermovox
