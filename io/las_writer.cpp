#include "io/las_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "io/little_endian.hpp"

namespace thermovox {
namespace {

constexpr std::uint8_t kPointFormat = 7;
constexpr std::uint16_t kPointBytes = 36 + 4 + 4 + 4 + 8;  // format 7 and the extra fields
constexpr std::uint16_t kHeaderBytes = 375;
constexpr std::size_t kExtraFieldBytes = 192;
constexpr std::uint16_t kWktBit = 1U << 4;  // of the global encoding; formats 6 to 10 must set it
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// Well-known text after OGC 01-009, as LAS 1.4 wants it. Two axes: PROJ refuses three in a LOCAL_CS, and
/// heights have the same unit. 10000 is the least type of a local datum.
constexpr std::string_view kCoordinateSystem =
    "LOCAL_CS[\"world of the map\",LOCAL_DATUM[\"local\",10000],UNIT[\"metre\",1],"
    "AXIS[\"X\",OTHER],AXIS[\"Y\",OTHER]]";

/// A number behind every point: LAS 1.4 R15, section "Extra Bytes".
struct ExtraField {
  enum Type : std::uint8_t { uint32 = 5, float32 = 9, float64 = 10 };
  std::string_view name;  ///< 32 characters at most, as the description
  std::string_view description;
  Type type;
};
constexpr std::array kExtraFields{
    ExtraField{"temperature", "Celsius; NaN where not seen", ExtraField::float32},
    ExtraField{"temperature_sigma", "of the mean, Celsius, one sigma", ExtraField::float32},
    ExtraField{"count", "temperatures in the mean", ExtraField::uint32},
    ExtraField{"time", "of the last one, Unix seconds", ExtraField::float64}};

/// Text in a field of fixed length, filled up with zeros. Precondition: it fits.
void appendText(std::string& bytes, std::string_view text, std::size_t length) {
  bytes += text;
  bytes.append(length - text.size(), '\0');
}

void appendVector(std::string& bytes, const Eigen::Vector3d& v) {
  for (int axis = 0; axis < 3; ++axis) appendLittleEndian(bytes, v[axis]);
}

void appendExtraField(std::string& bytes, const ExtraField& field) {
  const bool may_lack = field.type != ExtraField::uint32;
  appendLittleEndian(bytes, std::uint16_t{0});
  appendLittleEndian(bytes, std::uint8_t{field.type});
  appendLittleEndian(bytes, std::uint8_t{may_lack});  // options: bit 0 says that the value below is "no data"
  appendText(bytes, field.name, 32 + 4);
  appendLittleEndian(bytes, may_lack ? kNotKnown : 0.0);
  bytes.append(kExtraFieldBytes - 4 - 36 - 8 - 32, '\0');  // least, largest, scale, offset: not used
  appendText(bytes, field.description, 32);
}

/// A variable length record.
void appendRecord(std::string& bytes, std::string_view user, std::uint16_t id, std::string_view content) {
  appendLittleEndian(bytes, std::uint16_t{0});
  appendText(bytes, user, 16);
  appendLittleEndian(bytes, id);
  appendLittleEndian(bytes, static_cast<std::uint16_t>(content.size()));
  appendText(bytes, "", 32);
  bytes += content;
}

std::string variableRecords() {
  std::string fields, records;
  for (const ExtraField& field : kExtraFields) appendExtraField(fields, field);
  appendRecord(records, "LASF_Spec", 4, fields);
  appendRecord(records, "LASF_Projection", 2112, std::string(kCoordinateSystem) + '\0');
  return records;
}

/// Coordinates as whole steps: p = steps * scale + offset.
class Grid {
 public:
  explicit Grid(std::span<const SurfacePoint> points) {
    if (points.empty()) return;
    low_ = high_ = points.front().p_world.cast<double>();
    for (const SurfacePoint& point : points) {
      low_ = low_.cwiseMin(point.p_world.cast<double>());
      high_ = high_.cwiseMax(point.p_world.cast<double>());
    }
    offset_ = ((low_ + high_) / 2.0).array().round();
    constexpr double kMostSteps = 2147483000.0;  // of an int32, with some to spare for the rounding
    while ((high_ - low_).maxCoeff() / 2.0 + 1.0 > kMostSteps * scale_) scale_ *= 10.0;
  }

  [[nodiscard]] std::int32_t step(double coordinate, int axis) const {
    return static_cast<std::int32_t>(std::round((coordinate - offset_[axis]) / scale_));
  }
  /// Scale, offset, and the bounds of what a reader gets.
  void append(std::string& bytes) const {
    appendVector(bytes, Eigen::Vector3d::Constant(scale_));
    appendVector(bytes, offset_);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double bound : {high_[axis], low_[axis]}) {
        appendLittleEndian(bytes, step(bound, axis) * scale_ + offset_[axis]);
      }
    }
  }

 private:
  double scale_ = 1e-4;
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d high_ = Eigen::Vector3d::Zero();
};

/// The public header block.
std::string header(std::uint64_t points, const Grid& grid, std::size_t record_bytes) {
  std::string bytes = "LASF";
  appendLittleEndian(bytes, std::uint16_t{0});  // source
  appendLittleEndian(bytes, kWktBit);
  bytes.append(16, '\0');  // project
  bytes += {1, 4};
  appendText(bytes, "OTHER", 32);
  appendText(bytes, "thermovox", 32);
  bytes.append(4, '\0');  // day and year
  appendLittleEndian(bytes, kHeaderBytes);
  appendLittleEndian(bytes, static_cast<std::uint32_t>(kHeaderBytes + record_bytes));
  appendLittleEndian(bytes, std::uint32_t{2});  // variable length records
  appendLittleEndian(bytes, kPointFormat);
  appendLittleEndian(bytes, kPointBytes);
  bytes.append(4 + 5 * 4, '\0');  // the counts of LAS 1.3 and older: 0 with this point format
  grid.append(bytes);
  bytes.append(8 + 8 + 4, '\0');  // no waveforms, no extended records
  appendLittleEndian(bytes, points);
  appendLittleEndian(bytes, points);  // that are first returns,
  bytes.append(14 * 8, '\0');         // and later ones
  return bytes;
}

std::uint16_t intensityOf(double celsius, const TemperatureSpan& span) {
  const double place = std::clamp((celsius - span.low) / (span.high - span.low), 0.0, 1.0);
  return static_cast<std::uint16_t>(1.0 + std::round(place * 65534.0));
}

void appendPoint(std::string& bytes, const SurfacePoint& point, const Grid& grid,
                 const TemperatureScale& scale) {
  const auto& temperature = point.temperature;
  for (int axis = 0; axis < 3; ++axis) appendLittleEndian(bytes, grid.step(point.p_world[axis], axis));
  appendLittleEndian(bytes, temperature ? intensityOf(temperature->celsius, scale.span) : std::uint16_t{0});
  appendLittleEndian(bytes, std::uint8_t{0x11});  // return 1 of 1
  bytes.append(1 + 1 + 1 + 2 + 2 + 8, '\0');      // flags, class, user data, angle, source, GPS time
  const Rgb rgb = temperature ? scale.colourOf(temperature->celsius) : kUnknownColour;
  for (const std::uint8_t level : {rgb.r, rgb.g, rgb.b}) {
    appendLittleEndian(bytes, static_cast<std::uint16_t>(level * 257));
  }
  appendLittleEndian(bytes, temperature ? temperature->celsius : static_cast<float>(kNotKnown));
  appendLittleEndian(bytes, temperature ? temperature->sigma : static_cast<float>(kNotKnown));
  appendLittleEndian(bytes, temperature ? temperature->count : std::uint32_t{0});
  appendLittleEndian(bytes, temperature ? temperature->time : kNotKnown);
}

}  // namespace

void writeLas(const std::filesystem::path& path, std::span<const SurfacePoint> points,
              const ColourScale& scale, Existing existing) {
  const Grid grid(points);
  const TemperatureScale colours{spanOf(points, scale), scale.palette};
  const std::string records = variableRecords();
  AtomicFile file(path, existing);
  file.write(header(points.size(), grid, records.size()));
  file.write(records);
  std::string bytes;
  for (const SurfacePoint& point : points) {
    bytes.clear();
    appendPoint(bytes, point, grid, colours);
    file.write(bytes);
  }
  file.commit();
}

}  // namespace thermovox
