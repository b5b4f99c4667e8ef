#include "io/cloud_writer.hpp"

#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "io/las_writer.hpp"
#include "io/little_endian.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();

/// A point as all formats write it.
struct Row {
  Eigen::Vector3f p_world;
  Rgb rgb;
  SurfaceTemperature temperature;  ///< NaN, count 0 where not seen

  Row(const SurfacePoint& point, const TemperatureSpan& span, Palette palette)
      : p_world(point.p_world),
        rgb(point.temperature ? colourOf(point.temperature->celsius, span, palette) : kUnknownColour),
        temperature(point.temperature.value_or(
            SurfaceTemperature{kNotKnown, kNotKnown, 0, std::numeric_limits<double>::quiet_NaN()})) {}

  [[nodiscard]] std::uint32_t packedRgb() const {
    return (std::uint32_t{rgb.r} << 16) | (std::uint32_t{rgb.g} << 8) | rgb.b;
  }
};

void appendPosition(std::string& bytes, const Row& row) {
  for (int axis = 0; axis < 3; ++axis) appendLittleEndian(bytes, row.p_world[axis]);
}

void appendTemperature(std::string& bytes, const Row& row) {
  appendLittleEndian(bytes, row.temperature.celsius);
  appendLittleEndian(bytes, row.temperature.sigma);
  appendLittleEndian(bytes, row.temperature.count);
  appendLittleEndian(bytes, row.temperature.time);
}

/// Writes a header and then, for every point, what append(bytes, row) says.
template <typename Append>
void writeFile(const std::filesystem::path& path, const std::string& header,
               std::span<const SurfacePoint> points, const ColourScale& scale, Existing existing,
               Append&& append) {
  const TemperatureSpan span = spanOf(points, scale);
  AtomicFile file(path, existing);
  file.write(header);
  std::string bytes;
  for (const SurfacePoint& point : points) {
    bytes.clear();
    append(bytes, Row(point, span, scale.palette));
    file.write(bytes);
  }
  file.commit();
}

}  // namespace

TemperatureSpan spanOf(std::span<const SurfacePoint> points, const ColourScale& scale) {
  if (scale.span) return *scale.span;
  std::vector<float> celsius;
  for (const SurfacePoint& point : points) {
    if (point.temperature) celsius.push_back(point.temperature->celsius);
  }
  return percentileSpan(celsius).value_or(TemperatureSpan{});
}

void writePcd(const std::filesystem::path& path, std::span<const SurfacePoint> points,
              const ColourScale& scale, Existing existing) {
  const std::string header = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
      "FIELDS x y z rgb temperature temperature_sigma count time\n"
      "SIZE 4 4 4 4 4 4 4 8\nTYPE F F F F F F U F\nCOUNT 1 1 1 1 1 1 1 1\n"
      "WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points.size());
  writeFile(path, header, points, scale, existing, [](std::string& bytes, const Row& row) {
    appendPosition(bytes, row);
    appendLittleEndian(bytes, row.packedRgb());
    appendTemperature(bytes, row);
  });
}

void writePly(const std::filesystem::path& path, std::span<const SurfacePoint> points,
              const ColourScale& scale, Existing existing) {
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment thermovox: metres, degrees Celsius, Unix seconds\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float scalar_temperature\nproperty float scalar_temperature_sigma\n"
      "property uint scalar_count\nproperty double scalar_time\nend_header\n",
      points.size());
  writeFile(path, header, points, scale, existing, [](std::string& bytes, const Row& row) {
    appendPosition(bytes, row);
    for (const std::uint8_t level : {row.rgb.r, row.rgb.g, row.rgb.b}) appendLittleEndian(bytes, level);
    appendTemperature(bytes, row);
  });
}

void writeCloudCsv(const std::filesystem::path& path, std::span<const SurfacePoint> points,
                   const ColourScale& scale, Existing existing) {
  const std::string header = "x,y,z,rgb,temperature,temperature_sigma,count,time\n";
  writeFile(path, header, points, scale, existing, [](std::string& text, const Row& row) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{:.6f}\n", row.p_world.x(),
                   row.p_world.y(), row.p_world.z(), row.packedRgb(), row.temperature.celsius,
                   row.temperature.sigma, row.temperature.count, row.temperature.time);
  });
}

void writeCloud(const std::filesystem::path& path, std::span<const SurfacePoint> points,
                const ColourScale& scale, Existing existing) {
  const std::string ending = endingOf(path);
  if (ending == ".pcd") return writePcd(path, points, scale, existing);
  if (ending == ".ply") return writePly(path, points, scale, existing);
  if (ending == ".las") return writeLas(path, points, scale, existing);
  if (ending == ".csv") return writeCloudCsv(path, points, scale, existing);
  throw ConfigError(path.string() + ": the ending is '" + ending + "', expected .pcd, .ply, .las or .csv");
}

}  // namespace thermovox
