#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "io/station.hpp"
#include "io/station_tiles.hpp"
#include "io/unfinished_file.hpp"

namespace thermovox {

/// What a station is made of. The order of missions and sources makes no difference.
struct StationContent {
  ThermalMap::Options options;
  struct Mission {
    MissionRecord record;
    std::unique_ptr<TileSource> layer;  ///< its own temperatures; null where nobody has kept them
  };
  std::vector<Mission> missions;
  std::vector<std::unique_ptr<TileSource>> sources;  ///< whose maps add up to that of the station
};

/// The missions of a station's database, which must live on, with their layers.
[[nodiscard]] std::vector<StationContent::Mission> storedMissions(const SqlDatabase& database,
                                                                  const std::filesystem::path& path);

/// A station file in the making: built whole beside its name, then put into place in one step. Until then,
/// and when it is not, nothing is to be seen under the name. Its bytes depend on the content alone: missions
/// lie in the order of their flights, tiles in the order of their keys, and no page is left over. DataErrors
/// name the station.
class StationWriter {
 public:
  /// Removes what killed processes left of such files. Throws DataError when the folder does not exist or
  /// nothing can be written in it.
  explicit StationWriter(std::filesystem::path path);
  ~StationWriter();
  StationWriter(const StationWriter&) = delete;
  StationWriter& operator=(const StationWriter&) = delete;

  /// Writes the file and brings it to the disk; on so many threads (0: one for each processor).
  void write(StationContent content, int threads);
  /// Gives it its name, unless that is taken: false.
  [[nodiscard]] bool publishNew();
  /// Gives it its name and the permissions of the file there, which it replaces; who has that open keeps it.
  void publishOver();

 private:
  std::filesystem::path path_;
  std::filesystem::path file_;  ///< the path, links followed
  std::optional<UnfinishedFile> unfinished_;
};

}  // namespace thermovox
