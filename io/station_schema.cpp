#include "io/station_schema.hpp"

#include <array>
#include <string>
#include <utility>

#include "io/frame_pose_codec.hpp"
#include "io/number_text.hpp"
#include "io/pose_text.hpp"
#include "io/shared_motion_codec.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::int64_t kApplicationId = 0x54565831;  // "TVX1": file(1) and SQLite show it

// What `sqlite3 plant.tvx .schema` shows. Times are Unix nanoseconds, NULL where there are none.
// T_world_mission is "tx ty tz qx qy qz qw" where a merge has moved the mission, NULL where none has.
constexpr const char* kTables = R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE missions (
  id INTEGER PRIMARY KEY, name TEXT NOT NULL, rig TEXT NOT NULL, parameters TEXT NOT NULL,
  readings INTEGER NOT NULL, points INTEGER NOT NULL, coloured INTEGER NOT NULL,
  first_ns INTEGER, last_ns INTEGER, version TEXT NOT NULL, mapped_at INTEGER NOT NULL,
  T_world_mission TEXT, ambient REAL, pose_rotation_sigma REAL NOT NULL, pose_translation_sigma REAL NOT NULL,
  shared_motions BLOB NOT NULL, frame_poses BLOB NOT NULL, has_layer INTEGER NOT NULL);
CREATE TABLE tiles (
  x INTEGER NOT NULL, y INTEGER NOT NULL, z INTEGER NOT NULL,
  blocks INTEGER NOT NULL, surfaces INTEGER NOT NULL, data BLOB NOT NULL, PRIMARY KEY (x, y, z));
CREATE TABLE layers (
  mission INTEGER NOT NULL REFERENCES missions, x INTEGER NOT NULL, y INTEGER NOT NULL, z INTEGER NOT NULL,
  blocks INTEGER NOT NULL, surfaces INTEGER NOT NULL, data BLOB NOT NULL, PRIMARY KEY (mission, x, y, z));
)sql";

constexpr const char* kMissionColumns =
    "name, rig, parameters, readings, points, coloured, first_ns, last_ns, version, mapped_at";
constexpr const char* kLaterColumns =
    "T_world_mission, ambient, pose_rotation_sigma, pose_translation_sigma, shared_motions, frame_poses, "
    "has_layer";

/// The options by their keys in `meta`; one list for writing and reading.
auto optionFields(auto& options) {
  using Field = std::pair<const char*, decltype(&options.resolution)>;
  return std::array<Field, 6>{{{"resolution", &options.resolution},
                               {"prob_hit", &options.occupancy.prob_hit},
                               {"prob_miss", &options.occupancy.prob_miss},
                               {"clamp_min", &options.occupancy.clamp_min},
                               {"clamp_max", &options.occupancy.clamp_max},
                               {"occupied", &options.occupancy.occupied}}};
}

/// The counts by their keys in `meta`.
auto countFields(auto& counts) {
  using Field = std::pair<const char*, decltype(&counts.tiles)>;
  return std::array<Field, 5>{{{"missions", &counts.missions},
                               {"tiles", &counts.tiles},
                               {"blocks", &counts.blocks},
                               {"surfaces", &counts.surfaces},
                               {"layer_tiles", &counts.layer_tiles}}};
}

void writeMeta(SqlDatabase& database, std::string_view key, std::string_view value) {
  database.prepare("INSERT OR REPLACE INTO meta VALUES (?, ?)").bindText(1, key).bindText(2, value).run();
}

std::optional<std::string> metaText(const SqlDatabase& database, const char* key) {
  SqlStatement query = database.prepare("SELECT value FROM meta WHERE key = ?");
  query.bindText(1, key);
  return query.step() ? std::optional(query.text(0)) : std::nullopt;
}

double readMeta(const SqlDatabase& database, const char* key, const std::filesystem::path& path) {
  const std::optional<std::string> text = metaText(database, key);
  const std::optional<double> number = text ? parseNumber(*text) : std::nullopt;
  if (!number) throw DataError(path.string() + ": is damaged, its table meta has no number for " + key);
  return *number;
}

/// What a mission declares of its errors, from the columns of version 4.
void readErrors(const SqlStatement& row, MissionRecord& record, const std::filesystem::path& path) {
  if (!row.isNull(11)) record.ambient = row.real(11);
  record.pose_sigmas = {row.real(12), row.real(13)};
  try {
    record.shared_motions = decodeSharedMotions(row.blob(14));
    record.frame_poses = decodeFramePoses(row.blob(15));
  } catch (const DataError& error) {
    throw DataError(path.string() + ": is damaged, mission " + inQuotes(record.name) + ": " + error.what());
  }
}

}  // namespace

void createStationTables(SqlDatabase& database) {
  database.execute(kTables);
  database.execute("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.execute("PRAGMA user_version = " + std::to_string(kStationSchema));
}

void writeStationMeta(SqlDatabase& database, const ThermalMap::Options& options) {
  writeMeta(database, "schema_version", std::to_string(kStationSchema));
  writeMeta(database, "frame", "world: metres, right-handed, z up");
  for (const auto& [key, value] : optionFields(options)) writeMeta(database, key, exactText(*value));
  const Station::Counts counts = countStation(database);
  for (const auto& [key, count] : countFields(counts)) writeMeta(database, key, std::to_string(*count));
}

void insertMission(SqlDatabase& database, const MissionRecord& record, HasLayer has_layer) {
  SqlStatement insert =
      database.prepare("INSERT INTO missions (" + std::string(kMissionColumns) + ", " + kLaterColumns +
                       ") VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bindText(1, record.name).bindText(2, record.rig).bindText(3, record.parameters);
  insert.bind(4, record.readings).bind(5, record.points).bind(6, record.coloured);
  if (record.first) insert.bind(7, record.first->time_since_epoch().count());
  if (record.last) insert.bind(8, record.last->time_since_epoch().count());
  insert.bindText(9, record.version).bind(10, record.mapped_at);
  if (record.T_world_mission) insert.bindText(11, poseText(*record.T_world_mission));
  if (record.ambient) insert.bindReal(12, *record.ambient);
  insert.bindReal(13, record.pose_sigmas.rotation).bindReal(14, record.pose_sigmas.translation);
  insert.bindBlob(15, encodeSharedMotions(record.shared_motions));
  insert.bindBlob(16, encodeFramePoses(record.frame_poses));
  insert.bind(17, has_layer == HasLayer::yes ? 1 : 0).run();
}

bool hasLayer(const SqlDatabase& database, std::int64_t mission_id) {
  if (stationVersion(database) < 4) return false;
  return database.integer("SELECT count(*) FROM missions WHERE has_layer AND id = " +
                          std::to_string(mission_id)) == 1;
}

std::vector<MissionRecord> readMissions(const SqlDatabase& database, const std::filesystem::path& path) {
  const std::int64_t version = stationVersion(database);
  const char* const later = version >= 4 ? kLaterColumns : (version >= 2 ? "T_world_mission" : "NULL");
  std::vector<MissionRecord> missions;
  SqlStatement query = database.prepare("SELECT " + std::string(kMissionColumns) + ", " + later +
                                        " FROM missions ORDER BY id");
  while (query.step()) {
    MissionRecord& record = missions.emplace_back();
    record.name = query.text(0);
    record.rig = query.text(1);
    record.parameters = query.text(2);
    record.readings = query.integer(3);
    record.points = query.integer(4);
    record.coloured = query.integer(5);
    if (!query.isNull(6)) record.first = Time(Duration(query.integer(6)));
    if (!query.isNull(7)) record.last = Time(Duration(query.integer(7)));
    record.version = query.text(8);
    record.mapped_at = query.integer(9);
    if (version >= 4) readErrors(query, record, path);
    if (query.isNull(10)) continue;
    record.T_world_mission = parsePose(query.text(10));
    if (record.T_world_mission) continue;
    throw DataError(path.string() + ": is damaged, T_world_mission of the mission " + inQuotes(record.name) +
                    " is " + inQuotes(query.text(10)) + ", expected tx ty tz qx qy qz qw");
  }
  return missions;
}

void checkStationTables(const SqlDatabase& database, const std::filesystem::path& path) {
  if (database.integer("PRAGMA application_id") != kApplicationId) {
    throw DataError(path.string() + ": is a SQLite database but not a station");
  }
  const std::int64_t version = stationVersion(database);
  if (version > kStationSchema) {
    throw DataError(path.string() + ": was written by a newer thermovox (station version " +
                    std::to_string(version) + "), expected version " + std::to_string(kStationSchema) +
                    " or older: update the program");
  }
  if (version < 1) throw DataError(path.string() + ": is a station of an unknown version");
}

std::int64_t stationVersion(const SqlDatabase& database) {
  return database.integer("PRAGMA user_version");
}

Station::Counts countStation(const SqlDatabase& database) {
  return {database.integer("SELECT count(*) FROM missions"), database.integer("SELECT count(*) FROM tiles"),
          database.integer("SELECT coalesce(sum(blocks), 0) FROM tiles"),
          database.integer("SELECT coalesce(sum(surfaces), 0) FROM tiles"),
          stationVersion(database) < 4 ? 0 : database.integer("SELECT count(*) FROM layers")};
}

void checkCounts(const SqlDatabase& database, const std::filesystem::path& path) {
  const Station::Counts counts = countStation(database);
  for (const auto& [key, count] : countFields(counts)) {
    if (count == &counts.layer_tiles && stationVersion(database) < 4) continue;
    const double recorded = readMeta(database, key, path);
    if (recorded == static_cast<double>(*count)) continue;
    throw DataError(path.string() + ": is damaged, it holds " + std::to_string(*count) + " " + key +
                    ", expected " + exactText(recorded) + " as it says itself");
  }
}

std::string readStationFrame(const SqlDatabase& database, const std::filesystem::path& path) {
  if (const std::optional<std::string> frame = metaText(database, "frame")) return *frame;
  throw DataError(path.string() + ": is damaged, its table meta has no frame");
}

ThermalMap::Options readStationOptions(const SqlDatabase& database, const std::filesystem::path& path) {
  ThermalMap::Options options;
  for (const auto& [key, value] : optionFields(options)) *value = readMeta(database, key, path);
  try {
    const ThermalMap valid(options);
  } catch (const ConfigError& error) {
    throw DataError(path.string() + ": is damaged, " + error.what());
  }
  return options;
}

}  // namespace thermovox
