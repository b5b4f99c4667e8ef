#include "io/pose_text.hpp"

#include <array>
#include <cmath>

#include "io/number_text.hpp"
#include "io/unit_quaternion.hpp"

namespace thermovox {

std::string poseText(const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  std::string text;
  for (const double number : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    if (!text.empty()) text += ' ';
    text += exactText(number);
  }
  return text;
}

std::optional<Pose> parsePose(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::array<double, 7> numbers{};
  std::size_t count = 0;
  for (std::size_t begin = text.find_first_not_of(blanks); begin != std::string_view::npos; ++count) {
    const std::size_t end = text.find_first_of(blanks, begin);
    const std::optional<double> number = parseNumber(text.substr(begin, end - begin));
    if (count == numbers.size() || !number || !std::isfinite(*number)) return std::nullopt;
    numbers[count] = *number;
    begin = text.find_first_not_of(blanks, end);
  }
  if (count != numbers.size()) return std::nullopt;
  const auto rotation = unitQuaternion(numbers[3], numbers[4], numbers[5], numbers[6]);
  if (!rotation) return std::nullopt;
  return Pose{*rotation, {numbers[0], numbers[1], numbers[2]}};
}

}  // namespace thermovox
