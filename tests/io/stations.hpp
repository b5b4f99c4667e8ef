#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <string>
#include <vector>

#include "io/station.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox::test {

namespace fs = std::filesystem;

[[nodiscard]] inline MissionRecord record(const std::string& name) {
  return {.name = name,
          .rig = "laser: {kind: beam}\n",
          .parameters = "resolution: 0.1\n",
          .readings = 5,
          .points = 1000,
          .coloured = 666,
          .first = Time(Duration(-5)),
          .last = Time(Duration(1'700'000'000'123'456'789)),
          .version = "0.1.0",
          .mapped_at = 1'700'000'100};
}

[[nodiscard]] inline std::string missionName(unsigned seed) {
  return std::string("m").append(std::to_string(seed));
}

/// A station of missions named m1, m2 ... of these seeds.
inline fs::path stationOf(const TestFolder& folder, const std::vector<unsigned>& seeds,
                          const char* name = "plant.tvx") {
  const fs::path path = folder / name;
  Station station = Station::create(path, randomMission(0).options());
  for (const unsigned seed : seeds) {
    station.addMission(record(missionName(seed)), randomMission(seed), KnownMission::refuse);
  }
  return path;
}

[[nodiscard]] inline ThermalMap merged(const std::vector<unsigned>& seeds) {
  ThermalMap map(randomMission(0).options());
  for (const unsigned seed : seeds) map.merge(randomMission(seed));
  return map;
}

inline void executeSql(const fs::path& path, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
}

[[nodiscard]] inline std::string refusal(const fs::path& path) {
  return messageOf<DataError>([&] { (void)Station::open(path).loadMap(); });
}

[[nodiscard]] inline std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

}  // namespace thermovox::test
