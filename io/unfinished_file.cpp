#include "io/unfinished_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "io/folders.hpp"
#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kEnding = ".unfinished";

/// Whether the name is NAME.<process>-<n>.unfinished.
bool isOf(const std::string& file, std::string_view name) {
  if (!name.starts_with(file + ".") || !name.ends_with(kEnding)) return false;
  if (name.size() <= file.size() + 1 + kEnding.size()) return false;
  name.remove_prefix(file.size() + 1);
  name.remove_suffix(kEnding.size());
  const std::size_t dash = name.find('-');
  return dash != std::string_view::npos && parseInteger(name.substr(0, dash)).has_value() &&
         parseInteger(name.substr(dash + 1)).has_value();
}

/// A name that no other of this process has.
fs::path newName(const fs::path& file) {
  static std::atomic<unsigned> count = 0;
  return file.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(count++) + kEnding.data();
}

/// Whether the open file still lies under this name.
bool isNamed(int descriptor, const fs::path& path) {
  struct stat open_file {};
  struct stat named {};
  return ::fstat(descriptor, &open_file) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         open_file.st_dev == named.st_dev && open_file.st_ino == named.st_ino;
}

bool lock(int descriptor, int how) {
  int failed = 0;
  do {
    failed = ::flock(descriptor, how);
  } while (failed != 0 && errno == EINTR);
  return failed == 0;
}

void removeUnlessHeld(const fs::path& path) {
  // To lock over NFS takes the right to write.
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return;
  if (lock(descriptor, LOCK_EX | LOCK_NB) && isNamed(descriptor, path)) ::unlink(path.c_str());
  ::close(descriptor);
}

void removeLeftBeside(const fs::path& file) {
  std::error_code ignored;
  const std::string name = file.filename().string();
  for (const auto& entry : fs::directory_iterator(folderOf(file), ignored)) {
    if (isOf(name, entry.path().filename().string())) removeUnlessHeld(entry.path());
  }
}

}  // namespace

UnfinishedFile::UnfinishedFile(const fs::path& file, const fs::path& shown) {
  removeLeftBeside(file);
  for (;;) {
    path_ = newName(file);
    descriptor_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno == EEXIST) continue;  // of a process of this number on another host
    if (descriptor_ < 0) {
      throw DataError(shown.string() + ": cannot be written, nothing can be created in its folder (" +
                      std::strerror(errno) + ")");
    }
    // Another process may have seen the file before it was locked, and removed it.
    if (!lock(descriptor_, LOCK_EX) || isNamed(descriptor_, path_)) return;
    ::close(descriptor_);
  }
}

UnfinishedFile::~UnfinishedFile() {
  if (descriptor_ < 0) return;
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

void UnfinishedFile::keep() {
  ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace thermovox
