#include "calibration/laser_sights.hpp"

#include <algorithm>

#include "calibration/board_search.hpp"

namespace thermovox {
namespace {

constexpr double kOffDirection = 0.2;  // of the distance: 11 degrees
constexpr double kOffPlace = 0.1;      // metres

ReturnSet nearBoard(const ReturnSet& returns, const Eigen::Vector3d& middle, double half_diagonal) {
  const double reach = half_diagonal + kOffPlace + kOffDirection * middle.norm();
  ReturnSet near;
  std::copy_if(returns.begin(), returns.end(), std::back_inserter(near),
               [&](const Eigen::Vector3d& p) { return (p - middle).norm() <= reach; });
  return near;
}

}  // namespace

std::vector<LaserSight> laserSights(
    const CalibrationInput& input, const std::vector<BoardCapture>& captures,
    const std::vector<Pose>& T_reference_board, SearchWhere where,
    const std::function<void(const std::string& stage, double done)>& progress) {
  const LaserGuess& laser = *input.laser;
  const double half_diagonal = 0.5 * plateOf(input.board).norm();
  std::vector<LaserSight> sights;
  for (std::size_t i = 0; i < captures.size(); ++i) {
    sights.push_back({T_reference_board[i], {}});
    const auto seen = [](const std::optional<BoardView>& view) { return view.has_value(); };
    if (std::none_of(captures[i].views.begin(), captures[i].views.end(), seen)) continue;
    ReturnSet returns = captures[i].returns_laser;
    if (where == SearchWhere::near_guess && laser.kind == LaserKind::cloud)
      returns = nearBoard(returns, laser.T_reference_laser.inverse() * T_reference_board[i].translation,
                          half_diagonal);
    for (const ReturnSet& candidate : boardCandidates(returns, laser.kind, input.board)) {
      if (auto moments = planeMoments(candidate, laser.kind, laser.range_sigma))
        sights.back().candidates.push_back(*std::move(moments));
    }
    if (progress)
      progress("boards in the laser", static_cast<double>(i + 1) / static_cast<double>(captures.size()));
  }
  return sights;
}

}  // namespace thermovox
