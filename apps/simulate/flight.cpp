#include "apps/simulate/flight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/simulate/random.hpp"

namespace thermovox::simulate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

double wave(double amplitude, double frequency, double seconds, double phase) {
  return amplitude * std::sin(2.0 * kPi * frequency * seconds + phase);
}

/// From 0 to 1 with two continuous derivatives.
double smoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

/// A triangle wave with rounded corners, -1 at 0, +1 at 1, -1 at 2.
double roundedTriangle(double half_laps) {
  constexpr double kSharpness = 0.96;
  return -std::asin(kSharpness * std::cos(kPi * half_laps)) / std::asin(kSharpness);
}

}  // namespace

Flight::Flight(const Hall& hall, FlightStyle style, double duration, std::uint64_t seed)
    : style_(style), half_length_(hall.size().x() / 2 - 2.2), lap_(std::clamp(duration, 6.0, 40.0)) {
  Random random(seed, RandomStream::flight);
  for (double& phase : phases_) phase = random.uniform(0.0, 2.0 * kPi);
}

/// Half a turn at each end of the aisle, where the body is slow.
double Flight::headingOf(double half_laps) const {
  constexpr double kTurn = 0.36;  // share of half a lap that a turn takes
  const double end = std::round(half_laps);
  const double turned = end - 1.0 + smoothStep((half_laps - end) / kTurn + 0.5);
  return kPi * turned + (style_ == FlightStyle::facing_rows ? kPi / 2 : 0.0);
}

Pose Flight::at(double seconds) const {
  // The first turn, at 0, is over by 0.18: a mission begins on the straight.
  const double half_laps = 0.2 + 2.0 * seconds / lap_;
  const Eigen::Vector3d position(half_length_ * roundedTriangle(half_laps), -0.5 * std::sin(kPi * half_laps),
                                 1.75 + wave(0.2, 0.31, seconds, phases_[0]));
  double yaw = headingOf(half_laps) + wave(4.0 * kDegree, 0.83, seconds, phases_[1]);
  double pitch = wave(2.0 * kDegree, 0.71, seconds, phases_[2]);
  if (style_ == FlightStyle::facing_rows) {
    pitch += wave(23.0 * kDegree, 0.53, seconds, phases_[3]);
  } else {
    yaw += wave(75.0 * kDegree, 0.36, seconds, phases_[3]);
    pitch += wave(12.0 * kDegree, 0.23, seconds, phases_[5]);
  }
  const double roll = wave(3.0 * kDegree, 0.47, seconds, phases_[4]);
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  return {rotation.normalized(), position};
}

std::vector<StampedPose> Flight::sample(double from, double to, double rate) const {
  std::vector<StampedPose> poses;
  const auto count = static_cast<std::int64_t>(std::ceil((to - from) * rate - 1e-9));
  for (std::int64_t i = 0; i <= count; ++i) {
    const Time stamp = kStart + durationFromSeconds(from + static_cast<double>(i) / rate);
    poses.push_back({stamp, at(stamp)});
  }
  return poses;
}

}  // namespace thermovox::simulate
