#include "io/station_writer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <tuple>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/folders.hpp"
#include "io/number_text.hpp"
#include "io/parallel_for.hpp"
#include "io/pose_text.hpp"
#include "io/station_schema.hpp"
#include "io/tile_codec.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kUnfinished = ".unfinished";
/// Tiles that are encoded at a time.
constexpr std::size_t kBatch = 64;

[[noreturn]] void fail(const fs::path& path, const char* action, int error) {
  throw DataError(path.string() + ": " + action + " (" + std::strerror(error) + ")");
}

/// Whether the name is NAME.tvx.<process>-<number>.unfinished of a process that lives no more.
bool isLeftover(std::string_view name, const std::string& station) {
  if (!name.starts_with(station + ".") || !name.ends_with(kUnfinished)) return false;
  name.remove_prefix(station.size() + 1);
  name.remove_suffix(kUnfinished.size());
  const std::optional<int> process = parseInteger(name.substr(0, name.find('-')));
  return process && *process > 0 && ::kill(*process, 0) != 0 && errno == ESRCH;
}

void removeLeftovers(const fs::path& station) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folderOf(station), ignored)) {
    if (isLeftover(entry.path().filename().string(), station.filename().string()))
      fs::remove(entry.path(), ignored);
  }
}

/// A name beside the station's that no other writer of this or another process has.
fs::path unfinishedName(const fs::path& path) {
  static std::atomic<unsigned> count = 0;
  return path.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(count++) +
         kUnfinished.data();
}

/// Brings a file or folder to the disk.
void syncToDisk(const fs::path& file, const fs::path& shown) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(shown, "cannot be written", errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (error != 0) fail(shown, "cannot be written", error);
}

/// What all sources have of one tile.
struct TileJob {
  TileKey key;
  std::vector<TileSource::Part> parts;
};

std::vector<TileJob> nextJobs(std::vector<std::unique_ptr<TileSource>>& sources) {
  std::vector<TileJob> jobs;
  while (jobs.size() < kBatch) {
    std::optional<TileKey> first;
    for (const auto& source : sources) {
      if (const auto key = source->key(); key && (!first || *key < *first)) first = key;
    }
    if (!first) break;
    TileJob& job = jobs.emplace_back(TileJob{*first, {}});
    for (const auto& source : sources) {
      if (source->key() == first) job.parts.push_back(source->next());
    }
  }
  return jobs;
}

/// The sum of what the sources have. A tile that one station alone has goes on as it is.
StoredTile stored(TileJob& job, const fs::path& path) {
  TileSource::Part& only = job.parts.front();
  if (job.parts.size() == 1 && only.stored && only.current) return std::move(*only.stored);
  if (job.parts.size() == 1 && only.tile) {
    const std::vector<BlockView> blocks = viewsOf(job.key, *only.tile);
    std::size_t surfaces = 0;
    for (const BlockView& view : blocks) surfaces += view.block->surfaceCount();
    return {job.key, static_cast<std::int64_t>(blocks.size()), static_cast<std::int64_t>(surfaces),
            encodeTile(blocks)};
  }
  TileBlocks sum;
  for (TileSource::Part& part : job.parts) {
    if (part.stored) {
      for (const auto& [key, block] : decodeStoredTile(*part.stored, path)) sum[key].merge(block);
    } else {
      for (const BlockView& view : viewsOf(job.key, *part.tile)) sum[view.key].merge(*view.block);
    }
  }
  return {job.key, static_cast<std::int64_t>(sum.size()), surfacesIn(sum), encodeTile(sum)};
}

void writeTiles(SqlDatabase& database, std::vector<std::unique_ptr<TileSource>>& sources, int threads,
                const fs::path& path) {
  SqlStatement insert = database.prepare("INSERT INTO tiles VALUES (?, ?, ?, ?, ?, ?)");
  for (std::vector<TileJob> jobs = nextJobs(sources); !jobs.empty(); jobs = nextJobs(sources)) {
    std::vector<StoredTile> tiles(jobs.size());
    parallelFor(jobs.size(), threads, [&](std::size_t i) { tiles[i] = stored(jobs[i], path); });
    for (const StoredTile& tile : tiles) {
      insert.bind(1, tile.key.x).bind(2, tile.key.y).bind(3, tile.key.z);
      insert.bind(4, tile.blocks).bind(5, tile.surfaces).bindBlob(6, tile.data).run();
    }
  }
}

}  // namespace

void sortMissions(std::vector<MissionRecord>& missions) {
  const auto key = [](const MissionRecord& m) {
    return std::tuple(!m.first, m.first, m.name, m.last, m.readings, m.points, m.coloured, m.mapped_at, m.rig,
                      m.parameters, m.version, m.T_world_mission ? poseText(*m.T_world_mission) : "");
  };
  std::sort(missions.begin(), missions.end(),
            [&](const MissionRecord& a, const MissionRecord& b) { return key(a) < key(b); });
}

StationWriter::StationWriter(fs::path path) : path_(std::move(path)), file_(path_) {
  checkFolderOf(path_);
  std::error_code ignored;
  if (fs::is_symlink(path_, ignored)) {
    if (!fs::exists(path_, ignored))
      throw DataError(path_.string() + ": is a link to nothing, expected a station or a free name");
    file_ = fs::canonical(path_);
  }
  removeLeftovers(file_);
  unfinished_ = unfinishedName(file_);
  const int descriptor = ::open(unfinished_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(path_, "cannot be written, nothing can be created in its folder", errno);
  ::close(descriptor);
}

StationWriter::~StationWriter() {
  std::error_code ignored;
  if (!unfinished_.empty()) fs::remove(unfinished_, ignored);
}

void StationWriter::write(StationContent content, int threads) {
  sortMissions(content.missions);
  {
    SqlDatabase database(unfinished_, SqlDatabase::Mode::build, path_.string());
    database.execute("BEGIN");
    createStationTables(database);
    for (const MissionRecord& mission : content.missions) insertMission(database, mission);
    writeTiles(database, content.sources, threads, path_);
    writeStationMeta(database, content.options);
    database.execute("COMMIT");
  }
  syncToDisk(unfinished_, path_);
}

bool StationWriter::publishNew() {
  const int renamed = ::renameat2(AT_FDCWD, unfinished_.c_str(), AT_FDCWD, file_.c_str(), RENAME_NOREPLACE);
  if (renamed != 0 && errno == EINVAL) {  // a file system that cannot (NFS)
    if (::link(unfinished_.c_str(), file_.c_str()) == 0) {
      ::unlink(unfinished_.c_str());
    } else if (errno == EEXIST) {
      return false;
    } else {
      fail(path_, "cannot be put into place", errno);
    }
  } else if (renamed != 0) {
    if (errno == EEXIST) return false;
    fail(path_, "cannot be put into place", errno);
  }
  unfinished_.clear();
  syncFolderOf(file_);
  return true;
}

void StationWriter::publishOver() {
  struct stat old {};
  if (::stat(file_.c_str(), &old) == 0) ::chmod(unfinished_.c_str(), old.st_mode & 07777);
  if (::rename(unfinished_.c_str(), file_.c_str()) != 0) fail(path_, "cannot be put into place", errno);
  unfinished_.clear();
  syncFolderOf(file_);
}

}  // namespace thermovox
