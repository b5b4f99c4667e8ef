#include "io/points_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <string>

#include "projection/error.hpp"

namespace thermovox {

class PointsRecord::Format {
 public:
  virtual ~Format() = default;
  virtual void begin(AtomicFile& file) = 0;
  virtual void write(AtomicFile& file, std::span<const Row> rows) = 0;
  virtual void end(AtomicFile& file, std::uint64_t rows) = 0;
};

namespace {

class CsvFormat final : public PointsRecord::Format {
 public:
  void begin(AtomicFile& file) override { file.write("timestamp,x,y,z,range,u,v,temperature,sigma\n"); }

  void write(AtomicFile& file, std::span<const PointsRecord::Row> rows) override {
    text_.clear();
    for (const PointsRecord::Row& row : rows) {
      fmt::format_to(std::back_inserter(text_), "{},{:.4f},{:.4f},{:.4f},{:.4f},", formatTime(row.stamp),
                     row.p_world.x(), row.p_world.y(), row.p_world.z(), row.range);
      if (row.colour) {
        fmt::format_to(std::back_inserter(text_), "{:.3f},{:.3f},{:.3f},{:.4f}\n", row.colour->pixel.x(),
                       row.colour->pixel.y(), row.colour->celsius, row.colour->sigma);
      } else {
        fmt::format_to(std::back_inserter(text_), ",,,\n");
      }
    }
    file.write(std::string_view(text_.data(), text_.size()));
  }

  void end(AtomicFile& /*file*/, std::uint64_t /*rows*/) override {}

 private:
  fmt::memory_buffer text_;
};

/// Binary little endian. The number of points stands in the header and is known only at the end, so the
/// header is written again then: a comment behind the number takes up the rest of its room.
class PlyFormat final : public PointsRecord::Format {
 public:
  void begin(AtomicFile& file) override { file.write(header(0)); }

  void write(AtomicFile& file, std::span<const PointsRecord::Row> rows) override {
    bytes_.clear();
    for (const PointsRecord::Row& row : rows) {
      for (int axis = 0; axis < 3; ++axis) append(row.p_world[axis]);
      append(toUnixSeconds(row.stamp));
      constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
      append(row.colour ? row.colour->celsius : unknown);
      append(row.colour ? row.colour->sigma : unknown);
      append(static_cast<float>(row.range));
      append(row.colour ? static_cast<float>(row.colour->pixel.x()) : unknown);
      append(row.colour ? static_cast<float>(row.colour->pixel.y()) : unknown);
    }
    file.write(bytes_);
  }

  void end(AtomicFile& file, std::uint64_t rows) override { file.rewrite(0, header(rows)); }

 private:
  static std::string header(std::uint64_t rows) {
    constexpr std::size_t widest = 20;
    const std::string number = std::to_string(rows);
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + number +
           "\ncomment thermovox points record" + std::string(widest - number.size(), ' ') +
           "\nproperty double x\nproperty double y\nproperty double z\nproperty double timestamp\n"
           "property float scalar_temperature\nproperty float scalar_sigma\nproperty float scalar_range\n"
           "property float scalar_u\nproperty float scalar_v\nend_header\n";
  }

  template <typename Number>
  void append(Number value) {
    static_assert(std::endian::native == std::endian::little, "the record is written as the memory holds it");
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  std::string bytes_;
};

std::unique_ptr<PointsRecord::Format> formatFor(const std::filesystem::path& path) {
  if (path.extension() == ".csv") return std::make_unique<CsvFormat>();
  if (path.extension() == ".ply") return std::make_unique<PlyFormat>();
  throw ConfigError(path.string() + ": a points record ends in .csv or .ply, found '" +
                    path.extension().string() + "'");
}

constexpr auto kByStamp = [](const PointsRecord::Row& a, const PointsRecord::Row& b) {
  return a.stamp < b.stamp;
};

}  // namespace

PointsRecord::PointsRecord(const std::filesystem::path& path, RecordedPoints which, Existing existing)
    : file_(path, existing), which_(which), format_(formatFor(path)) {
  format_->begin(file_);
}

PointsRecord::~PointsRecord() = default;

void PointsRecord::add(std::span<const ColouredReturn> reading) {
  if (reading.empty()) return;
  const auto first = std::min_element(reading.begin(), reading.end(), [](const auto& a, const auto& b) {
    return a.placed.stamp < b.placed.stamp;
  });
  writeBefore(first->placed.stamp);
  for (const ColouredReturn& point : reading) {
    if (!point.colour && which_ == RecordedPoints::coloured) continue;
    waiting_.push_back({point.placed.stamp, point.placed.p_world, point.placed.range, point.colour});
  }
}

void PointsRecord::writeBefore(Time stamp) {
  std::stable_sort(waiting_.begin(), waiting_.end(), kByStamp);
  const auto end = std::lower_bound(waiting_.begin(), waiting_.end(), Row{.stamp = stamp}, kByStamp);
  const auto rows = static_cast<std::size_t>(end - waiting_.begin());
  format_->write(file_, std::span(waiting_).first(rows));
  written_ += rows;
  waiting_.erase(waiting_.begin(), end);
}

void PointsRecord::flush() {
  writeBefore(Time::max());
  format_->end(file_, written_);
  file_.sync();
}

void PointsRecord::commit() {
  flush();
  file_.commit();
}

}  // namespace thermovox
