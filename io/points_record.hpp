#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "io/atomic_file.hpp"
#include "mapping/mission_mapper.hpp"

namespace thermovox {

/// Which points a record holds.
enum class RecordedPoints {
  coloured,  ///< those with a temperature
  all,       ///< those without too, with empty fields
};

/// The record of every laser point, in time order: timestamp, x, y, z (world, metres), range (the laser's own
/// reading, metres), u, v (pixel of the thermal frame), temperature and its sigma (C). As CSV or, by the
/// file's ending, as binary PLY with double coordinates and stamps.
class PointsRecord {
 public:
  /// Throws ConfigError when the ending is neither .csv nor .ply, DataError when the file cannot be made.
  PointsRecord(const std::filesystem::path& path, RecordedPoints which, Existing existing);
  ~PointsRecord();

  /// Readings are to come in the order of their stamps; points within and across them are sorted here.
  void add(std::span<const ColouredReturn> reading);
  /// Brings all that was added to the disk, still beside the file's name: for verbs that change something
  /// else before commit(), which after this can hardly fail any more. What is added later stands behind it.
  void flush();
  /// Writes what is left and puts the file into place.
  void commit();

  /// One line of the record.
  struct Row {
    Time stamp;
    Eigen::Vector3d p_world;
    double range = 0.0;
    std::optional<Colour> colour;
  };
  /// How rows are spelled in one kind of file.
  class Format;

 private:
  void writeBefore(Time stamp);

  AtomicFile file_;
  RecordedPoints which_;
  std::unique_ptr<Format> format_;
  std::vector<Row> waiting_;  ///< until no earlier one can come
  std::uint64_t written_ = 0;
};

}  // namespace thermovox
