#include "calibration/residual_summary.hpp"

#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

/// Sum of squares and number of the returns of a capture: their own scatter about their plane, and how far
/// that is off the board.
struct Returns {
  double squares = 0.0, count = 0.0;
};

Returns returnsOf(const PlaneMoments& plane, const RigEstimate& estimate, std::size_t capture) {
  double shift = 0.0;
  for (std::size_t k = 0; k < plane.corner_rays.size(); ++k)
    shift += std::pow(rangeOfBoard(estimate, capture, plane.corner_rays[k]) - plane.corner_ranges[k], 2);
  shift /= static_cast<double>(plane.corner_rays.size());
  return {plane.returns * (plane.sigma * plane.sigma + shift), static_cast<double>(plane.returns)};
}

}  // namespace

double rangeOfBoard(const RigEstimate& estimate, std::size_t capture, const Eigen::Vector3d& ray_laser) {
  const Pose T_board_laser = estimate.T_reference_board[capture].inverse() * estimate.T_reference_laser;
  return -T_board_laser.translation.z() / (T_board_laser.rotation * ray_laser).z();
}

ResidualSummary summarise(const BundleData& data, const RigEstimate& estimate) {
  const std::size_t cameras = estimate.cameras.size();
  ResidualSummary summary{std::vector<int>(cameras, 0), std::vector<double>(cameras, 0.0)};
  Returns all;
  for (std::size_t i = 0; i < data.captures.size(); ++i) {
    for (const CornerObservation& corner : data.captures[i].corners) {
      const auto camera = static_cast<std::size_t>(corner.camera);
      const Intrinsics& lens = estimate.cameras[camera];
      const Eigen::Vector3d p =
          estimate.T_camera_reference[camera] *
          (estimate.T_reference_board[i] * data.points[static_cast<std::size_t>(corner.point)]);
      summary.rms_px[camera] +=
          (pixelFromCamera<double>(lens.model, lens.parameters.data(), p) - corner.pixel).squaredNorm();
      ++summary.corners[camera];
    }
    if (!data.captures[i].plane) continue;
    const Returns own = returnsOf(*data.captures[i].plane, estimate, i);
    all.squares += own.squares;
    all.count += own.count;
  }
  for (std::size_t camera = 0; camera < cameras; ++camera)
    summary.rms_px[camera] = std::sqrt(summary.rms_px[camera] / std::max(1, summary.corners[camera]));
  summary.rms_mm = 1e3 * std::sqrt(all.squares / std::max(1.0, all.count));
  return summary;
}

}  // namespace thermovox
