#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "io/folders.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr int kMostNames = 100;
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

/// Where a file without name can be found to give it one.
std::string linkOf(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

}  // namespace

std::string endingOf(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

void checkFolderOf(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(folderOf(path), ignored)) return;
  throw DataError(path.string() + ": the folder " + folderOf(path).string() +
                  " does not exist, expected one to write into");
}

void checkOutput(const std::filesystem::path& path, Existing existing) {
  checkFolderOf(path);
  std::error_code ignored;
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
  open();
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor_, 0666 & ~mask);  // it was made private to the user, a result is not
}

void AtomicFile::open() {
  descriptor_ = ::open(folderOf(path_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor_ >= 0) {
    if (::access(linkOf(descriptor_).c_str(), F_OK) == 0) return;
    ::close(descriptor_);  // without /proc it could not be given a name
  }
  std::string name = path_.string() + ".XXXXXX";
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("cannot be created");
  temporary_ = name;
}

/// Gives a file without name one: its own where that is free; where it is to be replaced one beside it.
void AtomicFile::link() {
  const std::string file = linkOf(descriptor_);
  const auto linkAs = [&](const std::string& name) {
    return ::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  if (linkAs(path_.string())) return;
  const bool replace = existing_ == Existing::replace;
  for (int attempt = 0; replace && errno == EEXIST && attempt < kMostNames; ++attempt) {
    const std::string name =
        path_.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    if (!linkAs(name)) continue;
    temporary_ = name;
    return;
  }
  fail("cannot be put into place");
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
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

void AtomicFile::sync() {
  flush();
  if (::fsync(descriptor_) != 0) fail("cannot be written");
}

void AtomicFile::commit() {
  sync();
  checkOutput(path_, existing_);
  if (temporary_.empty()) link();
  if (!temporary_.empty() && ::rename(temporary_.c_str(), path_.c_str()) != 0) {
    fail("cannot be renamed into place");
  }
  ::close(descriptor_);
  descriptor_ = -1;
  syncFolderOf(path_);
}

}  // namespace thermovox
