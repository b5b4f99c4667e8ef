#include "io/tum_trajectory.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <string_view>

#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "io/unit_quaternion.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kColumns = 8;
constexpr std::string_view kForm = "timestamp tx ty tz qx qy qz qw";

/// The columns of a line; more than kColumns are counted but not kept.
std::size_t splitAtBlanks(std::string_view line, std::array<std::string_view, kColumns>& columns) {
  constexpr std::string_view kBlanks = " \t\r\f\v";
  std::size_t count = 0;
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos; ++count) {
    const std::size_t end = line.find_first_of(kBlanks, begin);
    if (count < kColumns) columns[count] = line.substr(begin, end - begin);
    begin = line.find_first_not_of(kBlanks, end);
  }
  return count;
}

StampedPose poseFromLine(std::string_view line, const std::string& place) {
  std::array<std::string_view, kColumns> columns;
  const std::size_t count = splitAtBlanks(line, columns);
  if (count != kColumns) {
    throw DataError(place + ": has " + std::to_string(count) + " columns, expected 8: " + std::string(kForm));
  }
  const std::optional<Time> stamp = parseTime(columns[0]);
  if (!stamp)
    throw DataError(place + ": found " + inQuotes(columns[0]) + ", expected a timestamp in decimal seconds");
  std::array<double, kColumns - 1> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<double> value = parseNumber(columns[i + 1]);
    if (!value || !std::isfinite(*value)) {
      throw DataError(place + ": found " + inQuotes(columns[i + 1]) + ", expected a finite number");
    }
    values[i] = *value;
  }
  const std::optional<Eigen::Quaterniond> rotation =
      unitQuaternion(values[3], values[4], values[5], values[6]);
  if (!rotation) throw DataError(place + ": " + quaternionFault(values[3], values[4], values[5], values[6]));
  return {*stamp, {*rotation, {values[0], values[1], values[2]}}};
}

}  // namespace

std::vector<StampedPose> readTumTrajectory(std::istream& stream, const std::string& name) {
  std::vector<StampedPose> poses;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    const std::string place = name + ":" + std::to_string(number);
    const StampedPose pose = poseFromLine(content, place);
    if (!poses.empty() && pose.stamp <= poses.back().stamp) {
      throw DataError(place + ": timestamp " + formatTime(pose.stamp) + " follows " +
                      formatTime(poses.back().stamp) + ", expected ascending timestamps");
    }
    poses.push_back(pose);
  }
  if (stream.bad()) throw DataError(name + ": reading failed");
  if (poses.empty()) throw DataError(name + ": holds no pose, expected lines of " + std::string(kForm));
  return poses;
}

std::vector<StampedPose> readTumTrajectory(const std::filesystem::path& file) {
  std::ifstream stream = openInput(file);
  return readTumTrajectory(stream, file.string());
}

}  // namespace thermovox
