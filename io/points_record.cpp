#include "io/points_record.hpp"

#include <fmt/format.h>

#include <bit>
#include <iterator>
#include <limits>
#include <string>

#include "projection/error.hpp"

namespace thermovox {

class PointsRecord::Format {
 public:
  virtual ~Format() = default;
  virtual void begin(AtomicFile& file, std::uint64_t rows) = 0;
  virtual void write(AtomicFile& file, std::span<const PointRow> rows) = 0;
};

namespace {

class CsvFormat final : public PointsRecord::Format {
 public:
  void begin(AtomicFile& file, std::uint64_t /*rows*/) override {
    file.write("timestamp,x,y,z,range,u,v,temperature,sigma\n");
  }

  void write(AtomicFile& file, std::span<const PointRow> rows) override {
    text_.clear();
    for (const PointRow& row : rows) {
      fmt::format_to(std::back_inserter(text_), "{},{:.4f},{:.4f},{:.4f},{:.4f},",
                     formatTime(Time(Duration(row.stamp))), row.p_world[0], row.p_world[1], row.p_world[2],
                     row.range);
      if (row.coloured != 0) {
        fmt::format_to(std::back_inserter(text_), "{:.3f},{:.3f},{:.3f},{:.4f}\n", row.pixel[0], row.pixel[1],
                       row.celsius, row.sigma);
      } else {
        fmt::format_to(std::back_inserter(text_), ",,,\n");
      }
    }
    file.write(std::string_view(text_.data(), text_.size()));
  }

 private:
  fmt::memory_buffer text_;
};

/// Binary little endian.
class PlyFormat final : public PointsRecord::Format {
 public:
  void begin(AtomicFile& file, std::uint64_t rows) override {
    file.write("ply\nformat binary_little_endian 1.0\ncomment thermovox points record\nelement vertex " +
               std::to_string(rows) +
               "\nproperty double x\nproperty double y\nproperty double z\nproperty double timestamp\n"
               "property float scalar_temperature\nproperty float scalar_sigma\nproperty float scalar_range\n"
               "property float scalar_u\nproperty float scalar_v\nend_header\n");
  }

  void write(AtomicFile& file, std::span<const PointRow> rows) override {
    bytes_.clear();
    for (const PointRow& row : rows) {
      for (const double coordinate : row.p_world) append(coordinate);
      append(toUnixSeconds(Time(Duration(row.stamp))));
      const auto orUnknown = [&](double value) {
        return row.coloured != 0 ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
      };
      append(orUnknown(row.celsius));
      append(orUnknown(row.sigma));
      append(static_cast<float>(row.range));
      append(orUnknown(row.pixel[0]));
      append(orUnknown(row.pixel[1]));
    }
    file.write(bytes_);
  }

 private:
  template <typename Number>
  void append(Number value) {
    static_assert(std::endian::native == std::endian::little, "the record is written as the memory holds it");
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  std::string bytes_;
};

std::unique_ptr<PointsRecord::Format> formatFor(const std::filesystem::path& path) {
  const std::string ending = endingOf(path);
  if (ending == ".csv") return std::make_unique<CsvFormat>();
  if (ending == ".ply") return std::make_unique<PlyFormat>();
  throw ConfigError(path.string() + ": a points record ends in .csv or .ply, found '" + ending + "'");
}

PointRow rowOf(const ColouredReturn& point) {
  const PlacedReturn& placed = point.placed;
  PointRow row{.stamp = placed.stamp.time_since_epoch().count(),
               .p_world = {placed.p_world.x(), placed.p_world.y(), placed.p_world.z()},
               .range = placed.range};
  if (point.colour) {
    row.pixel = {point.colour->pixel.x(), point.colour->pixel.y()};
    row.celsius = point.colour->celsius;
    row.sigma = point.colour->sigma;
    row.coloured = 1;
  }
  return row;
}

}  // namespace

PointsRecord::PointsRecord(const std::filesystem::path& path, RecordedPoints which, Existing existing)
    : file_(path, existing), which_(which), format_(formatFor(path)), rows_(path) {}

PointsRecord::~PointsRecord() = default;

void PointsRecord::add(std::span<const ColouredReturn> reading) {
  for (const ColouredReturn& point : reading) {
    if (point.colour || which_ == RecordedPoints::all) rows_.add(rowOf(point));
  }
}

void PointsRecord::finish() {
  format_->begin(file_, rows_.size());
  rows_.writeSorted([this](std::span<const PointRow> rows) { format_->write(file_, rows); });
  file_.sync();
}

void PointsRecord::commit() {
  file_.commit();
}

}  // namespace thermovox
