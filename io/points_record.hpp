#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "io/atomic_file.hpp"
#include "io/point_rows.hpp"
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

  /// Adds the points of a reading; readings may come in any order and overlap, they are sorted here.
  void add(std::span<const ColouredReturn> reading);
  /// Writes all that was added and brings it to the disk, still beside the file's name: for verbs that change
  /// something else before commit(), which after this can hardly fail any more. To be called once.
  void finish();
  /// Puts the finished file into place.
  void commit();

  /// How rows are spelled in one kind of file.
  class Format;

 private:
  AtomicFile file_;
  RecordedPoints which_;
  std::unique_ptr<Format> format_;
  PointRows rows_;
};

}  // namespace thermovox
