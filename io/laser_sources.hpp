#pragma once

#include <cstddef>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "projection/rig.hpp"
#include "projection/sources.hpp"

namespace thermovox {

/// The recording of one laser as it lies in a mission folder.
struct LaserRecording {
  std::filesystem::path folder;          ///< what the files in the recording are relative to
  std::string name;                      ///< stands for the recording in messages
  std::unique_ptr<std::istream> stream;  ///< beam.csv, scans.csv or clouds.csv
};

/// A source that turns the recording of the rig's laser number `index` into readings, one row at a time:
/// `timestamp,range[,strength]` (beam), `timestamp,r0,r1,...` (scan; as many ranges as the row has) or
/// `timestamp,file` (cloud), by the laser's kind. Ranges that are inf, nan, 0 or less are no returns.
/// next() throws DataError naming file and line, also for a clock that does not run forwards.
[[nodiscard]] std::unique_ptr<ReadingSource> readLaser(LaserRecording recording, const Laser& laser,
                                                       std::size_t index);

/// Several sources as one, in the order of their stamps; of equal stamps the earlier source goes first. It
/// holds one reading of each.
[[nodiscard]] std::unique_ptr<ReadingSource> mergeReadings(
    std::vector<std::unique_ptr<ReadingSource>> sources);

}  // namespace thermovox
