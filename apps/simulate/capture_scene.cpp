#include "apps/simulate/capture_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "apps/simulate/board_placing.hpp"
#include "apps/simulate/capture_rig.hpp"
#include "apps/simulate/parallel.hpp"
#include "apps/simulate/random.hpp"

namespace thermovox::simulate {
namespace {

constexpr double kNearestWall = 2.0;   // metres from the body
constexpr double kFarthestWall = 5.0;  // likewise

/// Numbers of captures of edges, and of what all captures share, apart from those of plain ones.
constexpr std::uint64_t kFirstEdge = 1'000'000;
constexpr std::uint64_t kShared = 2'000'000;
constexpr std::uint64_t kBias = 3'000'000;

Eigen::Vector3d wallDistances(Random& random) {
  const double x = random.uniform(kNearestWall, kFarthestWall);
  const double y = random.uniform(kNearestWall, kFarthestWall);
  const double z = random.uniform(kNearestWall, kFarthestWall);
  return {x, y, z};
}

/// Which of the plain captures are spoiled: the first ones of a shuffled row (Fisher and Yates).
std::vector<std::size_t> spoiledOnes(const CaptureOptions& options) {
  std::vector<std::size_t> order(static_cast<std::size_t>(options.captures));
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random random(options.seed, RandomStream::capture_motion, kShared);
  const auto wanted = static_cast<std::size_t>(options.spoiled);
  for (std::size_t i = 0; i < wanted; ++i) {
    const auto rest = static_cast<int>(order.size() - i);
    std::swap(order[i], order[i + static_cast<std::size_t>(random.index(rest))]);
  }
  order.resize(wanted);
  return order;
}

}  // namespace

CaptureScene::CaptureScene(const CaptureOptions& options) : options_(options), board_(simulatedBoard()) {
  options.validate();
  true_rig_ = drawTrueRig(options);
  guessed_rig_ = drawGuessedRig(options, true_rig_);
  Random room(options.seed, RandomStream::capture_boards, kShared);
  room_low_ = -wallDistances(room);
  room_high_ = wallDistances(room);
  const BoardPlacing placing(true_rig_, board_);
  const auto plain = static_cast<std::size_t>(options.captures);
  captures_.resize(static_cast<std::size_t>(options.count()));
  forEachIndex(captures_.size(), options.threads, [&](std::size_t i) {
    const auto side = static_cast<BoardSide>((i - plain) % 4);  // of captures of edges
    captures_[i] = i < plain ? placing.place(options.seed, i)
                             : placing.placeAtEdge(options.seed, kFirstEdge + (i - plain), side);
    Random bias(options.seed, RandomStream::capture_motion, kBias + i);
    captures_[i].range_bias = options.capture_bias_sigma * bias.normal();
  });
  for (const std::size_t i : spoiledOnes(options)) placing.spoil(captures_[i], options.seed, i);
}

Eigen::Vector3d CaptureScene::firstCorner() const {
  return {-0.5 * board_.square * (board_.columns - 1), -0.5 * board_.square * (board_.rows - 1), 0.0};
}

double CaptureScene::margin() const {
  return 0.5 * (board_.width - board_.square * (board_.columns + 1));
}

std::optional<double> CaptureScene::rangeOfPlate(const BoardCapture& capture, const Eigen::Vector3d& d_laser,
                                                 const Eigen::Vector2d& off_spot) const {
  const Pose T_board_laser = capture.T_body_board_at_laser.inverse() * true_rig_.lasers.front().T_body_laser;
  const auto hit = meetPlane(T_board_laser, d_laser);
  if (!hit) return std::nullopt;
  const Eigen::Vector2d spot = hit->place + off_spot;
  if (std::abs(spot.x()) > 0.5 * board_.width || std::abs(spot.y()) > 0.5 * board_.height)
    return std::nullopt;
  return hit->range;
}

double CaptureScene::rangeOfRoom(const Eigen::Vector3d& d_laser) const {
  const Pose& T_body_laser = true_rig_.lasers.front().T_body_laser;
  const Eigen::Vector3d d_body = T_body_laser.rotation * d_laser;
  double range = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (d_body[axis] == 0.0) continue;
    const double wall = d_body[axis] > 0.0 ? room_high_[axis] : room_low_[axis];
    range = std::min(range, (wall - T_body_laser.translation[axis]) / d_body[axis]);
  }
  return range;
}

}  // namespace thermovox::simulate
