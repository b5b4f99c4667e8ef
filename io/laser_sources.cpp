#include "io/laser_sources.hpp"

#include <optional>
#include <utility>

#include "io/csv.hpp"
#include "io/point_cloud_file.hpp"
#include "io/stamped_files.hpp"
#include "projection/error.hpp"
#include "projection/laser/multi_beam.hpp"
#include "projection/laser/planar_scanner.hpp"
#include "projection/laser/range_finder.hpp"

namespace thermovox {
namespace {

Reading numbered(Reading reading, std::size_t laser) {
  reading.laser = laser;
  return reading;
}

class BeamSource final : public ReadingSource {
 public:
  BeamSource(LaserRecording recording, const Laser& laser, std::size_t index)
      : rows_(CsvReader(std::move(recording.stream), std::move(recording.name))),
        laser_(laser),
        index_(index) {}

  std::optional<Reading> next() override {
    if (!rows_.next()) return std::nullopt;
    const CsvReader& row = rows_.row();
    const std::size_t count = row.fields().size();
    if (count != 2 && count != 3) {
      throw DataError(row.place() + ": has " + std::to_string(count) +
                      " field(s), expected timestamp,range[,strength]");
    }
    BeamReading beam{.stamp = rows_.stamp(), .range = row.number(1)};
    if (count == 3 && !row.fields()[2].empty()) beam.intensity = static_cast<float>(row.number(2));
    return numbered(readingFromBeam(beam, laser_), index_);
  }

 private:
  StampedRows rows_;
  Laser laser_;
  std::size_t index_;
};

class ScanSource final : public ReadingSource {
 public:
  ScanSource(LaserRecording recording, const Laser& laser, std::size_t index)
      : rows_(CsvReader(std::move(recording.stream), std::move(recording.name))),
        laser_(laser),
        index_(index) {}

  std::optional<Reading> next() override {
    if (!rows_.next()) return std::nullopt;
    const CsvReader& row = rows_.row();
    if (row.fields().size() < 2) {
      throw DataError(row.place() + ": has a timestamp only, expected timestamp,r0,r1,...");
    }
    ranges_.clear();
    for (std::size_t i = 1; i < row.fields().size(); ++i)
      ranges_.push_back(static_cast<float>(row.number(i)));
    return numbered(readingFromScan(rows_.stamp(), ranges_, laser_), index_);
  }

 private:
  StampedRows rows_;
  Laser laser_;
  std::size_t index_;
  std::vector<float> ranges_;
};

class CloudSource final : public ReadingSource {
 public:
  CloudSource(LaserRecording recording, const Laser& laser, std::size_t index)
      : files_(std::move(recording.stream), std::move(recording.name), std::move(recording.folder),
               StampedFiles::Pages::refuse),
        laser_(laser),
        index_(index) {}

  std::optional<Reading> next() override {
    const std::optional<StampedFile> row = files_.next();
    if (!row) return std::nullopt;
    const std::vector<CloudPoint> points = readCloudPoints(row->file, row->place);
    return numbered(readingFromCloud(row->stamp, points, laser_), index_);
  }

 private:
  StampedFiles files_;
  Laser laser_;
  std::size_t index_;
};

class MergedSource final : public ReadingSource {
 public:
  explicit MergedSource(std::vector<std::unique_ptr<ReadingSource>> sources)
      : sources_(std::move(sources)), heads_(sources_.size()) {
    for (std::size_t i = 0; i < sources_.size(); ++i) heads_[i] = sources_[i]->next();
  }

  std::optional<Reading> next() override {
    std::size_t first = sources_.size();
    for (std::size_t i = 0; i < heads_.size(); ++i) {
      if (heads_[i] && (first == sources_.size() || heads_[i]->stamp < heads_[first]->stamp)) first = i;
    }
    if (first == sources_.size()) return std::nullopt;
    std::optional<Reading> reading = std::move(heads_[first]);
    heads_[first] = sources_[first]->next();
    return reading;
  }

 private:
  std::vector<std::unique_ptr<ReadingSource>> sources_;
  std::vector<std::optional<Reading>> heads_;
};

}  // namespace

std::unique_ptr<ReadingSource> readLaser(LaserRecording recording, const Laser& laser, std::size_t index) {
  switch (laser.kind) {
    case LaserKind::beam:
      return std::make_unique<BeamSource>(std::move(recording), laser, index);
    case LaserKind::scan:
      return std::make_unique<ScanSource>(std::move(recording), laser, index);
    case LaserKind::cloud:
      break;
  }
  return std::make_unique<CloudSource>(std::move(recording), laser, index);
}

std::unique_ptr<ReadingSource> mergeReadings(std::vector<std::unique_ptr<ReadingSource>> sources) {
  return std::make_unique<MergedSource>(std::move(sources));
}

}  // namespace thermovox
