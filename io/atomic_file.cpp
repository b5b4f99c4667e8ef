#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

/// Makes a rename last: the folder's own entry has to reach the disk too.
void syncFolder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder that cannot be opened for reading can still be written to
  ::fsync(descriptor);
  ::close(descriptor);
}

std::filesystem::path folderOf(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

}  // namespace

void checkOutput(const std::filesystem::path& path, Existing existing) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folderOf(path), ignored)) {
    throw DataError(path.string() + ": the folder " + folderOf(path).string() + " does not exist");
  }
  if (std::filesystem::is_directory(path, ignored)) {
    throw DataError(path.string() + ": is a folder, expected the name of a file to write");
  }
  if (existing == Existing::refuse && std::filesystem::exists(path, ignored)) {
    throw DataError(path.string() + ": exists already, expected a new name (or --force to replace it)");
  }
}

AtomicFile::AtomicFile(std::filesystem::path path, Existing existing)
    : path_(std::move(path)), existing_(existing) {
  checkOutput(path_, existing_);
  std::string name = path_.string() + ".XXXXXX";
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("cannot be created");
  temporary_ = name;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor_, 0666 & ~mask);  // mkostemp makes it private to the user, a result is not
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void AtomicFile::fail(const char* action) const {
  throw DataError(path_.string() + ": " + action + " (" + std::strerror(errno) + ")");
}

void AtomicFile::writeOut(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written");
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::flush() {
  writeOut(buffer_);
  buffer_.clear();
}

void AtomicFile::write(std::string_view text) {
  buffer_.append(text);
  if (buffer_.size() >= kBufferBytes) flush();
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void AtomicFile::rewrite(std::uint64_t offset, std::string_view text) {
  flush();
  const off_t end = ::lseek(descriptor_, 0, SEEK_CUR);
  if (end < 0 || ::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0) fail("cannot be written");
  writeOut(text);
  if (::lseek(descriptor_, end, SEEK_SET) < 0) fail("cannot be written");
}

void AtomicFile::sync() {
  flush();
  if (::fsync(descriptor_) != 0) fail("cannot be written");
}

void AtomicFile::commit() {
  sync();
  checkOutput(path_, existing_);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be renamed into place");
  ::close(descriptor_);
  descriptor_ = -1;
  syncFolder(folderOf(path_));
}

}  // namespace thermovox
