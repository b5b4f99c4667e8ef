#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <optional>
#include <vector>

#include "calibration/board_plane.hpp"
#include "calibration/edge_residual.hpp"
#include "projection/camera.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// Everything that the bundle varies. The reference camera is the first one.
struct RigEstimate {
  std::vector<Intrinsics> cameras;
  std::vector<Pose> T_camera_reference;  ///< of each camera; the first is the identity and stays it
  Pose T_reference_laser;
  std::vector<Pose> T_reference_board;  ///< of each capture
  std::vector<double> range_bias;       ///< of each capture, metres
  double common_range_bias = 0.0;       ///< metres; held at 0 unless the rig gives it a sigma
  double edge_bias = 0.0;               ///< what the width of the beam adds to every edge, metres
};

/// A corner in an image that counts.
struct CornerObservation {
  int camera = 0;
  int point = 0;  ///< of boardPoints()
  Eigen::Vector2d pixel;
  Eigen::Matrix2d covariance;  ///< px^2
};

/// What the bundle knows of one capture.
struct CaptureObservations {
  std::vector<CornerObservation> corners;
  std::optional<PlaneMoments> plane;  ///< none: the capture says nothing of the laser
  std::vector<EdgeSide> edges;
};

struct BundleData {
  std::vector<Eigen::Vector3d> points;  ///< boardPoints()
  std::vector<CaptureObservations> captures;
  LaserKind laser = LaserKind::cloud;
};

/// Which unknowns are free, and how far measurements err besides what they say themselves.
struct BundleModel {
  std::vector<std::vector<int>> free_intrinsics;  ///< of each camera: places in Intrinsics::parameters
  std::vector<double> corner_factor;     ///< of each camera: what its corners' sigmas are to be multiplied by
  double edge_factor = 1.0;              ///< likewise of edges
  double plane_factor = 1.0;             ///< likewise of ranges
  double edge_offset_sigma = 0.0;        ///< what all crossings of one side err by together, metres
  double range_bias_sigma = 0.005;       ///< of one capture, metres
  double common_range_bias_sigma = 0.0;  ///< of all ranges, metres; 0: there is none
  double edge_bias_sigma = 0.010;        ///< metres
  enum class Loss { none, huber };
  Loss corner_loss = Loss::none;  ///< Huber's at two sigmas
};

struct BundleFit {
  RigEstimate estimate;
  double cost = 0.0;  ///< half the sum of squares, or of the loss
  bool converged = false;
};

/// The estimate of least squares from `start`: corners in pixels, planes and edges in the laser, and the
/// priors of the biases, all in sigmas (Ceres, Levenberg and Marquardt). Every board of `start` has to lie
/// before the cameras that see it.
[[nodiscard]] BundleFit solveBundle(const BundleData& data, const RigEstimate& start,
                                    const BundleModel& model);

/// Where the unknowns stand in the tangent vector. Poses are (rotation, translation); see pose_manifold.hpp
/// for what their rotations are about.
struct TangentLayout {
  int laser = 0, laser_size = 0;         ///< 6, a beam's 5, or 0 where no laser is in it
  std::vector<int> intrinsics;           ///< first of each camera
  std::vector<int> camera_pose;          ///< of each camera; -1 of the reference
  int common_bias = -1, edge_bias = -1;  ///< -1 where there is none
  std::vector<int> range_bias;           ///< of each capture; -1 where there is none
  std::vector<int> board;                ///< of each capture; -1 where nobody sees it
  int size = 0;
};

/// Rows of the Jacobian that stand and fall together.
struct RowGroup {
  enum class Kind { corners, plane, edges, prior };
  Kind kind = Kind::corners;
  int capture = -1;  ///< -1 of a prior that all captures share
  int camera = -1;   ///< of corners
  int first = 0;
  int count = 0;
};

/// The bundle about an estimate: residuals and their derivatives, in sigmas.
struct Linearisation {
  TangentLayout layout;
  Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian;
  Eigen::VectorXd residuals;
  std::vector<RowGroup> groups;
};

[[nodiscard]] Linearisation linearise(const BundleData& data, const RigEstimate& estimate,
                                      const BundleModel& model);

}  // namespace thermovox
