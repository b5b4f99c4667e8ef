#include "io/station_writer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <tuple>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/folders.hpp"
#include "io/parallel_for.hpp"
#include "io/pose_text.hpp"
#include "io/station_schema.hpp"
#include "io/tile_codec.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace fs = std::filesystem;
namespace {

/// Tiles that are encoded at a time.
constexpr std::size_t kBatch = 64;

[[noreturn]] void fail(const fs::path& path, const char* action, int error) {
  throw DataError(path.string() + ": " + action + " (" + std::strerror(error) + ")");
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

/// The sum of what the sources have. A tile that one station alone has goes on as it is, once it is found
/// sound: a station that is damaged must not become one that looks whole.
StoredTile stored(TileJob& job) {
  TileSource::Part& only = job.parts.front();
  if (job.parts.size() == 1 && only.stored && only.current) {
    (void)decodeStoredTile(*only.stored, only.station);
    return std::move(*only.stored);
  }
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
      for (const auto& [key, block] : decodeStoredTile(*part.stored, part.station)) sum[key].merge(block);
    } else {
      for (const BlockView& view : viewsOf(job.key, *part.tile)) sum[view.key].merge(*view.block);
    }
  }
  return {job.key, static_cast<std::int64_t>(sum.size()), surfacesIn(sum), encodeTile(sum)};
}

/// `insert` takes a tile's key, its counts and its bytes.
void writeTiles(SqlStatement insert, std::vector<std::unique_ptr<TileSource>>& sources, int threads) {
  for (std::vector<TileJob> jobs = nextJobs(sources); !jobs.empty(); jobs = nextJobs(sources)) {
    std::vector<StoredTile> tiles(jobs.size());
    parallelFor(jobs.size(), threads, [&](std::size_t i) { tiles[i] = stored(jobs[i]); });
    for (const StoredTile& tile : tiles) {
      insert.bind(1, tile.key.x).bind(2, tile.key.y).bind(3, tile.key.z);
      insert.bind(4, tile.blocks).bind(5, tile.surfaces).bindBlob(6, tile.data).run();
    }
  }
}

void writeMissions(SqlDatabase& database, std::vector<StationContent::Mission>& missions, int threads) {
  for (const StationContent::Mission& mission : missions) {
    insertMission(database, mission.record, mission.layer ? HasLayer::yes : HasLayer::no);
  }
  for (std::size_t i = 0; i < missions.size(); ++i) {
    if (!missions[i].layer) continue;
    const std::string id = std::to_string(i + 1);
    std::vector<std::unique_ptr<TileSource>> layer;
    layer.push_back(std::move(missions[i].layer));
    writeTiles(database.prepare("INSERT INTO layers VALUES (" + id + ", ?, ?, ?, ?, ?, ?)"), layer, threads);
  }
}

/// In the order of their flights: by first stamp, then name; those without stamps last.
void sortMissions(std::vector<StationContent::Mission>& missions) {
  const auto key = [](const StationContent::Mission& mission) {
    const MissionRecord& m = mission.record;
    return std::tuple(!m.first, m.first, m.name, m.last, m.readings, m.points, m.coloured, m.mapped_at, m.rig,
                      m.parameters, m.version, m.T_world_mission ? poseText(*m.T_world_mission) : "");
  };
  std::sort(
      missions.begin(), missions.end(),
      [&](const StationContent::Mission& a, const StationContent::Mission& b) { return key(a) < key(b); });
}

}  // namespace

std::vector<StationContent::Mission> storedMissions(const SqlDatabase& database, const fs::path& path) {
  std::vector<StationContent::Mission> missions;
  for (MissionRecord& record : readMissions(database, path)) {
    const auto id = static_cast<std::int64_t>(missions.size()) + 1;
    missions.push_back({std::move(record), nullptr});
    if (hasLayer(database, id)) missions.back().layer = std::make_unique<StationTiles>(database, path, id);
  }
  return missions;
}

StationWriter::StationWriter(fs::path path) : path_(std::move(path)), file_(path_) {
  checkFolderOf(path_);
  std::error_code ignored;
  if (fs::is_symlink(path_, ignored)) {
    if (!fs::exists(path_, ignored))
      throw DataError(path_.string() + ": is a link to nothing, expected a station or a free name");
    file_ = fs::canonical(path_);
  }
  unfinished_.emplace(file_, path_);
}

StationWriter::~StationWriter() = default;

void StationWriter::write(StationContent content, int threads) {
  sortMissions(content.missions);
  {
    SqlDatabase database(unfinished_->path(), SqlDatabase::Mode::build, path_.string());
    database.execute("BEGIN");
    createStationTables(database);
    writeMissions(database, content.missions, threads);
    writeTiles(database.prepare("INSERT INTO tiles VALUES (?, ?, ?, ?, ?, ?)"), content.sources, threads);
    writeStationMeta(database, content.options);
    database.execute("COMMIT");
  }
  syncToDisk(unfinished_->path(), path_);
}

bool StationWriter::publishNew() {
  const int renamed =
      ::renameat2(AT_FDCWD, unfinished_->path().c_str(), AT_FDCWD, file_.c_str(), RENAME_NOREPLACE);
  if (renamed != 0 && errno == EINVAL) {  // a file system that cannot (NFS)
    if (::link(unfinished_->path().c_str(), file_.c_str()) == 0) {
      ::unlink(unfinished_->path().c_str());
    } else if (errno == EEXIST) {
      return false;
    } else {
      fail(path_, "cannot be put into place", errno);
    }
  } else if (renamed != 0) {
    if (errno == EEXIST) return false;
    fail(path_, "cannot be put into place", errno);
  }
  unfinished_->keep();
  syncFolderOf(file_);
  return true;
}

void StationWriter::publishOver() {
  struct stat old {};
  if (::stat(file_.c_str(), &old) == 0) ::chmod(unfinished_->path().c_str(), old.st_mode & 07777);
  if (::rename(unfinished_->path().c_str(), file_.c_str()) != 0)
    fail(path_, "cannot be put into place", errno);
  unfinished_->keep();
  syncFolderOf(file_);
}

}  // namespace thermovox
