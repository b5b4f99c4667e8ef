#include "calibration/view_pose.hpp"

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

namespace thermovox {

std::optional<Pose> poseFromView(const std::vector<Eigen::Vector3d>& points, const BoardView& view,
                                 const Camera& camera) {
  std::vector<cv::Point3d> board;
  std::vector<cv::Point2d> rays;  // (x, y, 1) in the camera, so that the lens is out of it
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::optional<Eigen::Vector3d> ray = camera.rayFromPixel(view[i].pixel);
    if (!ray) continue;
    board.emplace_back(points[i].x(), points[i].y(), 0.0);
    rays.emplace_back(ray->x(), ray->y());
  }
  if (board.size() < 4) return std::nullopt;
  cv::Mat turn, translation;
  const cv::Mat one = cv::Mat::eye(3, 3, CV_64F);
  if (!cv::solvePnP(board, rays, one, cv::noArray(), turn, translation, false, cv::SOLVEPNP_IPPE)) {
    return std::nullopt;
  }
  const Eigen::Vector3d w(turn.at<double>(0), turn.at<double>(1), turn.at<double>(2));
  const Pose T_camera_board{
      expRotation(w), {translation.at<double>(0), translation.at<double>(1), translation.at<double>(2)}};
  if (!T_camera_board.rotation.coeffs().allFinite() || !T_camera_board.translation.allFinite())
    return std::nullopt;
  for (const Eigen::Vector3d& point : points) {
    if (!((T_camera_board * point).z() > 0.0)) return std::nullopt;
  }
  return T_camera_board;
}

}  // namespace thermovox
