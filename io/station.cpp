#include "io/station.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <map>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/number_text.hpp"
#include "io/sqlite.hpp"
#include "io/station_schema.hpp"
#include "io/tile_codec.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kUnfinished = ".unfinished";
constexpr std::string_view kJournal = "-journal";
constexpr const char* kMissionColumns =
    "name, rig, parameters, readings, points, coloured, first_ns, last_ns, version, mapped_at";

/// The key in the row's first three columns. A map reaches no further than kMaxCellKey.
TileKey tileKeyOf(const SqlStatement& row, const fs::path& path) {
  const auto index = [&](int column) {
    constexpr std::int64_t reach = kMaxCellKey >> (kBlockBits + kTileBits);
    const std::int64_t place = row.integer(column);
    if (place >= -reach && place <= reach) return static_cast<std::int32_t>(place);
    throw DataError(path.string() + ": is damaged, it has a tile at " + std::to_string(place) +
                    ", expected one within " + std::to_string(reach) + " of the origin");
  };
  return {index(0), index(1), index(2)};
}

/// The tile's blocks; the error names the station too.
TileBlocks decode(const TileKey& key, std::string_view bytes, const fs::path& path) {
  try {
    return decodeTile(key, bytes);
  } catch (const DataError& error) {
    throw DataError(path.string() + ": " + error.what());
  }
}

std::int64_t surfacesIn(const TileBlocks& blocks) {
  std::int64_t count = 0;
  for (const auto& [key, block] : blocks) count += static_cast<std::int64_t>(block.surfaceCount());
  return count;
}

/// A mission's blocks by the tiles they lie in.
std::map<TileKey, std::vector<BlockKey>> tilesOf(const ThermalMap& map) {
  std::map<TileKey, std::vector<BlockKey>> tiles;
  for (const BlockKey& key : map.sortedBlockKeys()) tiles[tileOf(key)].push_back(key);
  return tiles;
}

void bindTime(SqlStatement& statement, int parameter, const std::optional<Time>& time) {
  if (time) statement.bind(parameter, time->time_since_epoch().count());
}

void insertMission(SqlDatabase& database, const MissionRecord& record) {
  SqlStatement insert = database.prepare(std::string("INSERT INTO missions (") + kMissionColumns +
                                         ") VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bindText(1, record.name).bindText(2, record.rig).bindText(3, record.parameters);
  insert.bind(4, record.readings).bind(5, record.points).bind(6, record.coloured);
  bindTime(insert, 7, record.first);
  bindTime(insert, 8, record.last);
  insert.bindText(9, record.version).bind(10, record.mapped_at).run();
}

/// Merges the mission's blocks of every tile it touches into the stored ones.
void mergeTiles(SqlDatabase& database, const ThermalMap& mission_map, const fs::path& path) {
  SqlStatement select = database.prepare("SELECT data FROM tiles WHERE x = ? AND y = ? AND z = ?");
  SqlStatement replace = database.prepare("INSERT OR REPLACE INTO tiles VALUES (?, ?, ?, ?, ?, ?)");
  for (const auto& [tile, keys] : tilesOf(mission_map)) {
    select.bind(1, tile.x).bind(2, tile.y).bind(3, tile.z);
    TileBlocks blocks = select.step() ? decode(tile, select.blob(0), path) : TileBlocks{};
    select.reset();
    for (const BlockKey& key : keys) blocks[key].merge(*mission_map.block(key));
    replace.bind(1, tile.x).bind(2, tile.y).bind(3, tile.z);
    replace.bind(4, static_cast<std::int64_t>(blocks.size())).bind(5, surfacesIn(blocks));
    replace.bindBlob(6, encodeTile(tile, blocks)).run();
  }
}

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

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Whether the name is NAME.tvx.<process>.unfinished or its journal, of a process that lives no more.
bool isLeftover(std::string_view name, const std::string& station) {
  if (name.ends_with(kJournal)) name.remove_suffix(kJournal.size());
  if (!name.starts_with(station + ".") || !name.ends_with(kUnfinished)) return false;
  name.remove_prefix(station.size() + 1);
  name.remove_suffix(kUnfinished.size());
  const std::optional<int> process = parseInteger(name);
  return process && *process > 0 && ::kill(*process, 0) != 0 && errno == ESRCH;
}

/// Removes what killed processes left of this station's making.
void removeLeftovers(const fs::path& station) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folderOf(station), ignored)) {
    if (isLeftover(entry.path().filename().string(), station.filename().string()))
      fs::remove(entry.path(), ignored);
  }
}

void syncFolderOf(const fs::path& path) {
  const fs::path folder = folderOf(path);
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder that cannot be opened for reading can still be written to
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

/// The open database, and where it lies as long as the station has no mission.
struct Station::Storage {
  fs::path unfinished;  ///< empty once the station stands under its own name
  std::optional<SqlDatabase> database;

  Storage(const fs::path& file, SqlDatabase::Mode mode, const fs::path& shown) {
    database.emplace(file, mode, shown.string());
  }
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;
  ~Storage() {
    database.reset();
    if (unfinished.empty()) return;
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    fs::remove(unfinished.string() + kJournal.data(), ignored);
  }
};

Station::Station(fs::path path, ThermalMap::Options options, std::unique_ptr<Storage> storage)
    : path_(std::move(path)), options_(options), storage_(std::move(storage)) {}
Station::Station(Station&&) noexcept = default;
Station& Station::operator=(Station&&) noexcept = default;
Station::~Station() = default;

Station Station::open(const fs::path& path) {
  checkIsFile(path);
  auto storage = std::make_unique<Storage>(path, SqlDatabase::Mode::read_write, path);
  checkStationTables(*storage->database, path);
  const ThermalMap::Options options = readStationOptions(*storage->database, path);
  return {path, options, std::move(storage)};
}

Station Station::create(const fs::path& path, const ThermalMap::Options& options) {
  options.validate();
  checkOutput(path, Existing::refuse);
  removeLeftovers(path);
  const fs::path unfinished = path.string() + "." + std::to_string(::getpid()) + kUnfinished.data();
  std::error_code ignored;
  fs::remove(unfinished, ignored);
  auto storage = std::make_unique<Storage>(unfinished, SqlDatabase::Mode::create, path);
  storage->unfinished = unfinished;
  createStationTables(*storage->database, options);
  return {path, options, std::move(storage)};
}

/// The first mission is in: the file gets its name.
void Station::finishCreation() {
  checkOutput(path_, Existing::refuse);
  storage_->database.reset();
  std::error_code error;
  fs::rename(storage_->unfinished, path_, error);
  if (error) throw DataError(path_.string() + ": cannot be renamed into place (" + error.message() + ")");
  storage_->unfinished.clear();
  syncFolderOf(path_);
  storage_->database.emplace(path_, SqlDatabase::Mode::read_write, path_.string());
}

Station::Counts Station::counts() const {
  return countStation(*storage_->database);
}

std::vector<MissionRecord> Station::missions() const {
  std::vector<MissionRecord> missions;
  SqlStatement query =
      storage_->database->prepare(std::string("SELECT ") + kMissionColumns +
                                  ", first_ns IS NULL, last_ns IS NULL FROM missions ORDER BY id");
  while (query.step()) {
    MissionRecord record;
    record.name = query.text(0);
    record.rig = query.text(1);
    record.parameters = query.text(2);
    record.readings = query.integer(3);
    record.points = query.integer(4);
    record.coloured = query.integer(5);
    if (query.integer(10) == 0) record.first = Time(Duration(query.integer(6)));
    if (query.integer(11) == 0) record.last = Time(Duration(query.integer(7)));
    record.version = query.text(8);
    record.mapped_at = query.integer(9);
    missions.push_back(std::move(record));
  }
  return missions;
}

ThermalMap Station::loadMap() const {
  ThermalMap map(options_);
  SqlStatement query = storage_->database->prepare("SELECT x, y, z, data FROM tiles ORDER BY x, y, z");
  while (query.step()) {
    for (auto& [key, block] : decode(tileKeyOf(query, path_), query.blob(3), path_))
      map.setBlock(key, std::move(block));
  }
  return map;
}

void Station::checkNew(const std::string& mission) const {
  SqlStatement query = storage_->database->prepare("SELECT 1 FROM missions WHERE name = ?");
  query.bindText(1, mission);
  if (!query.step()) return;
  throw DataError(path_.string() + ": has the mission '" + mission +
                  "' already, expected one of another name (or --again to integrate it once more)");
}

void Station::addMission(const MissionRecord& record, const ThermalMap& mission_map, KnownMission known) {
  const std::array<Addition, 1> one{{{record, &mission_map}}};
  addMissions(one, known);
}

void Station::addMissions(std::span<const Addition> additions, KnownMission known) {
  for (const auto& [record, map] : additions) {
    if (map->options() == options_) continue;
    throw ConfigError(path_.string() + ": has cells of " + std::to_string(options_.resolution) +
                      " m, expected a mission mapped with the same resolution and occupancy model (it has " +
                      std::to_string(map->resolution()) + " m)");
  }
  SqlTransaction transaction(*storage_->database);
  checkCounts(*storage_->database, path_);
  for (const auto& [record, map] : additions) {
    if (known == KnownMission::refuse) checkNew(record.name);
    insertMission(*storage_->database, record);
    mergeTiles(*storage_->database, *map, path_);
  }
  recordCounts(*storage_->database);
  transaction.commit();
  if (!storage_->unfinished.empty()) finishCreation();
}

std::vector<std::string> Station::verify() const {
  std::vector<std::string> faults;
  try {
    SqlStatement check = storage_->database->prepare("PRAGMA integrity_check(20)");
    while (check.step()) {
      if (check.text(0) != "ok") faults.push_back(path_.string() + ": " + check.text(0));
    }
    try {
      checkCounts(*storage_->database, path_);
    } catch (const DataError& error) {
      faults.emplace_back(error.what());
    }
    (void)missions();
    SqlStatement query =
        storage_->database->prepare("SELECT x, y, z, data, blocks, surfaces FROM tiles ORDER BY x, y, z");
    while (query.step()) {
      try {
        const TileBlocks blocks = decode(tileKeyOf(query, path_), query.blob(3), path_);
        if (query.integer(4) != static_cast<std::int64_t>(blocks.size()) ||
            query.integer(5) != surfacesIn(blocks)) {
          faults.push_back(path_.string() +
                           ": a tile holds another number of blocks or surfaces than it says");
        }
      } catch (const DataError& error) {
        faults.emplace_back(error.what());
      }
    }
  } catch (const DataError& error) {
    faults.emplace_back(error.what());
  }
  return faults;
}

}  // namespace thermovox
