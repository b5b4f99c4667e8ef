#include "io/capture_laser.hpp"

#include <algorithm>
#include <fstream>
#include <utility>

#include "io/input_file.hpp"
#include "io/laser_sources.hpp"
#include "io/number_text.hpp"
#include "io/point_cloud_file.hpp"
#include "projection/error.hpp"
#include "projection/kind_names.hpp"
#include "projection/laser/multi_beam.hpp"

namespace thermovox {
namespace {

std::vector<Reading> readingsOf(const std::filesystem::path& file, const std::string& named_by,
                                const Laser& laser) {
  if (laser.kind == LaserKind::cloud)
    return {readingFromCloud(Time{}, readCloudPoints(file, named_by), laser)};
  const auto source = readLaser(
      {file.parent_path(), file.string(), std::make_unique<std::ifstream>(openInput(file, named_by))}, laser,
      0);
  std::vector<Reading> readings;
  while (std::optional<Reading> reading = source->next()) readings.push_back(std::move(*reading));
  return readings;
}

}  // namespace

std::vector<Reading> readCaptureLaser(const CaptureFiles& capture, const Laser& laser) {
  if (!capture.laser) return {};
  std::vector<Reading> readings = readingsOf(*capture.laser, capture.place + ", laser", laser);
  if (std::all_of(readings.begin(), readings.end(),
                  [](const Reading& reading) { return reading.returns.empty(); })) {
    throw DataError(capture.laser->string() + " (named by " + capture.place +
                    ", laser): has no return, expected some of a " + nameOf(laser.kind) + " from " +
                    exactText(laser.range_min) + " to " + exactText(laser.range_max) + " m");
  }
  return readings;
}

}  // namespace thermovox
