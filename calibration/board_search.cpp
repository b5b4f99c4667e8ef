#include "calibration/board_search.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/cloud_board.hpp"
#include "calibration/scan_board.hpp"

namespace thermovox {
namespace {

constexpr double kMostPlate = 1.4;  // of the pattern: a plate that is not known

/// The nearest readings that are near to each other, a tenth of all at least: the board stands in front.
std::vector<ReturnSet> beamCandidates(const ReturnSet& returns) {
  constexpr double kNear = 0.05;  // metres
  const std::size_t fewest = std::max<std::size_t>(3, returns.size() / 10);
  ReturnSet sorted = returns;
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  std::size_t begin = 0, best_begin = 0, best_end = 0;
  for (std::size_t end = 1; end <= sorted.size(); ++end) {
    while (sorted[end - 1].x() - sorted[begin].x() > kNear) ++begin;
    if (best_end > 0 && begin >= best_end) break;  // the next surface
    if (end - begin < fewest || end - begin < best_end - best_begin) continue;
    best_begin = begin;
    best_end = end;
  }
  if (best_end == 0) return {};
  return {{sorted.begin() + static_cast<std::ptrdiff_t>(best_begin),
           sorted.begin() + static_cast<std::ptrdiff_t>(best_end)}};
}

}  // namespace

Eigen::Vector2d plateOf(const CalibrationBoard& board) {
  const bool circles = board.pattern == CalibrationBoard::Pattern::asymmetric_circles;
  const Eigen::Vector2d pattern =
      board.square * (circles ? Eigen::Vector2d(2 * board.columns - 1, board.rows - 1)
                              : Eigen::Vector2d(board.columns + 1, board.rows + 1));
  return {board.width > 0.0 ? board.width : pattern.x(), board.height > 0.0 ? board.height : pattern.y()};
}

std::vector<ReturnSet> boardCandidates(const ReturnSet& returns_laser, LaserKind kind,
                                       const CalibrationBoard& board, std::size_t most) {
  std::vector<ReturnSet> candidates;
  switch (kind) {
    case LaserKind::beam:
      candidates = beamCandidates(returns_laser);
      break;
    case LaserKind::scan:
      candidates = boardsInScan(returns_laser, plateOf(board));
      break;
    case LaserKind::cloud:
      candidates = boardsInCloud(returns_laser, {plateOf(board), board.width > 0.0 ? 1.0 : kMostPlate});
      break;
  }
  if (candidates.size() > most) candidates.resize(most);
  return candidates;
}

ReturnSet returnsOnBoard(const ReturnSet& returns_laser, const Pose& T_laser_board,
                         const CalibrationBoard& board, double inset, double slack) {
  const Eigen::Vector2d half = (0.5 * plateOf(board)).array() - inset;
  const Eigen::Matrix3d R_board_laser = T_laser_board.matrix().transpose();
  const Eigen::Vector3d origin = -(R_board_laser * T_laser_board.translation);
  ReturnSet kept;
  for (const Eigen::Vector3d& p : returns_laser) {
    const Eigen::Vector3d ray = R_board_laser * p;  // as long as the range
    const double share = -origin.z() / ray.z();     // of the range, where the ray meets the plane
    if (!(share > 0.0) || !(std::abs(share - 1.0) * p.norm() <= slack)) continue;
    const Eigen::Vector2d hit = (origin + share * ray).head<2>();
    if (std::abs(hit.x()) <= half.x() && std::abs(hit.y()) <= half.y()) kept.push_back(p);
  }
  return kept;
}

}  // namespace thermovox
