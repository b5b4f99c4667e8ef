#include "io/station_file.hpp"

#include <sys/stat.h>

#include <array>
#include <fstream>
#include <string_view>
#include <thread>

#include "io/station_schema.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace fs = std::filesystem;
namespace {

constexpr std::chrono::milliseconds kPause{20};

/// Refuses what SQLite would take for an empty database or not name well.
void checkIsFile(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw DataError(path.string() + ": is a folder, expected a station file");
  if (!fs::exists(path, ignored))
    throw DataError(path.string() + ": does not exist, expected a station file");
  if (!fs::is_regular_file(path, ignored))
    throw DataError(path.string() + ": is no regular file, expected a station file");
  if (fs::file_size(path, ignored) == 0)
    throw DataError(path.string() + ": is empty, expected a station file");
}

/// Which file lies under a name just now.
struct FileId {
  dev_t device = 0;
  ino_t inode = 0;
  static FileId of(const fs::path& path) {
    struct stat found {};
    return ::stat(path.c_str(), &found) == 0 ? FileId{found.st_dev, found.st_ino} : FileId{};
  }
  friend bool operator==(const FileId&, const FileId&) = default;
};

/// The lock on the file that lies there; null while another process has it, or when it was replaced.
std::unique_ptr<SqlDatabase> tryLockStation(const fs::path& path) {
  checkIsFile(path);
  const FileId file = FileId::of(path);
  auto lock = std::make_unique<SqlDatabase>(path, SqlDatabase::Mode::lock, path.string());
  return lock->tryLock() && FileId::of(path) == file ? std::move(lock) : nullptr;
}

}  // namespace

SqlDatabase openStation(const fs::path& path) {
  checkIsFile(path);
  SqlDatabase database(path, SqlDatabase::Mode::read, path.string());
  checkStationTables(database, path);
  return database;
}

bool isDatabase(const fs::path& path) {
  constexpr std::string_view head("SQLite format 3\0", 16);
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::array<char, head.size()> found{};
  std::ifstream file(path, std::ios::binary);
  return file.read(found.data(), found.size()) && std::string_view(found.data(), found.size()) == head;
}

std::unique_ptr<SqlDatabase> lockStation(const fs::path& path, const StationPatience& patience) {
  const auto begin = std::chrono::steady_clock::now();
  for (bool waits = false;; waits = true) {
    if (auto lock = tryLockStation(path)) return lock;
    if (patience.most && std::chrono::steady_clock::now() - begin >= *patience.most)
      throw DataError(path.string() +
                      ": another process is writing it, expected it to finish: try again then");
    if (!waits && patience.begins) patience.begins();
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace thermovox
