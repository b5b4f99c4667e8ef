#include "io/unfinished_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>

#include "io/folders.hpp"
#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kEnding = ".unfinished";

/// Begins the host's part of the name of a file that could not be locked; no host's own name has it.
constexpr char kUnlocked = '@';
/// What another host holds may not be seen to be held; what it is at changes more often than this.
constexpr std::time_t kLeftAfter = 3600;  // seconds

/// The host's name, without what a file's should not hold.
std::string hostName() {
  std::array<char, 256> name{};
  (void)::gethostname(name.data(), name.size() - 1);
  std::string host = name.data();
  for (char& c : host) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (!plain && c != '.' && c != '-') c = '_';
  }
  return host;
}

/// Cuts the number after the last dash off; false when there is none.
bool cutNumber(std::string_view& name) {
  const std::size_t dash = name.rfind('-');
  if (dash == std::string_view::npos || !parseInteger(name.substr(dash + 1))) return false;
  name = name.substr(0, dash);
  return true;
}

/// The host in the name FILE.<host>-<process>-<n>.unfinished; nullopt in others.
std::optional<std::string> hostIn(std::string_view name, const std::string& file) {
  if (!name.starts_with(file + ".") || !name.ends_with(kEnding)) return std::nullopt;
  if (name.size() <= file.size() + 1 + kEnding.size()) return std::nullopt;
  name.remove_prefix(file.size() + 1);
  name.remove_suffix(kEnding.size());
  if (!cutNumber(name) || !cutNumber(name)) return std::nullopt;
  return std::string(name);
}

/// A name that no other of this process has.
fs::path newName(const fs::path& file, const std::string& host) {
  static std::atomic<unsigned> count = 0;
  return file.string() + "." + host + "-" + std::to_string(::getpid()) + "-" + std::to_string(count++) +
         kEnding.data();
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

bool isUnchanged(int descriptor) {
  struct stat found {};
  return ::fstat(descriptor, &found) == 0 && std::time(nullptr) - found.st_mtime > kLeftAfter;
}

/// Where locks are known to be seen, the lock alone tells.
enum class Locks { seen, doubtful };

void removeUnlessHeld(const fs::path& path, Locks locks) {
  // To lock over NFS takes the right to write.
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return;
  if (lock(descriptor, LOCK_EX | LOCK_NB) && isNamed(descriptor, path) &&
      (locks == Locks::seen || isUnchanged(descriptor)))
    ::unlink(path.c_str());
  ::close(descriptor);
}

void removeLeftBeside(const fs::path& file) {
  std::error_code ignored;
  const std::string name = file.filename().string(), here = hostName();
  for (const auto& entry : fs::directory_iterator(folderOf(file), ignored)) {
    const std::optional<std::string> host = hostIn(entry.path().filename().string(), name);
    if (host) removeUnlessHeld(entry.path(), *host == here ? Locks::seen : Locks::doubtful);
  }
}

}  // namespace

UnfinishedFile::UnfinishedFile(const fs::path& file, const fs::path& shown) {
  removeLeftBeside(file);
  for (;;) {
    path_ = newName(file, hostName());
    descriptor_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno == EEXIST) continue;  // of a process of this number on a host of this name
    if (descriptor_ < 0) {
      throw DataError(shown.string() + ": cannot be written, nothing can be created in its folder (" +
                      std::strerror(errno) + ")");
    }
    if (!lock(descriptor_, LOCK_EX)) {
      const fs::path unlocked = newName(file, kUnlocked + hostName());
      if (::rename(path_.c_str(), unlocked.c_str()) == 0) path_ = unlocked;
    }
    // Another process may have seen the file before it was locked or renamed, and removed it.
    if (isNamed(descriptor_, path_)) return;
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
