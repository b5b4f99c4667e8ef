#include "calibration/edge_alignment.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <variant>

namespace thermovox {
namespace {

constexpr double kMostSpacing = 8.0;    // px; beams farther apart do not say where the edge is
constexpr double kLeastSpacing = 0.02;  // px; nearer ones do not say what lies across it
constexpr double kPlaceSigma =
    0.25;                            // px, of any edge of temperature: corners, curves, other edges beside it
constexpr double kCostScale = 2.0;   // sigmas at which a residual has half the largest cost
constexpr double kTimeStep = 0.004;  // seconds, for the derivative by the stamp
constexpr int kMostSteps = 12;

/// T_camera_world of a frame, and at stamps a little earlier and later.
struct FramePoses {
  Pose now, earlier, later;
};

std::optional<FramePoses> posesOf(const EdgeScene& scene, Time stamp, double offset) {
  std::array<Pose, 3> T_camera_world;
  for (std::size_t i = 0; i < 3; ++i) {
    const double shift = offset + kTimeStep * (static_cast<double>(i) - 1.0);
    const auto T_world_body = scene.trajectory.at(stamp + durationFromSeconds(shift));
    if (std::holds_alternative<NoPose>(T_world_body)) return std::nullopt;
    T_camera_world[i] = (std::get<Pose>(T_world_body) * scene.T_body_camera).inverse();
  }
  return FramePoses{T_camera_world[1], T_camera_world[0], T_camera_world[2]};
}

/// What one frame's predictions have in common.
struct FrameView {
  FramePoses poses;
  Eigen::Matrix3d R_body_laser;
  Eigen::Vector3d t_body_laser;
};

std::optional<FrameView> viewOf(const EdgeScene& scene, const EdgeFrame& frame, const EdgeChange& change) {
  const auto poses = posesOf(scene, frame.stamp, change[6]);
  if (!poses) return std::nullopt;
  const Pose T_body_laser = changedPose(scene.T_body_laser, change);
  return FrameView{*poses, T_body_laser.matrix(), T_body_laser.translation};
}

std::optional<PredictedEdge> predict(const EdgeScene& scene, const FrameView& view, const PlacedEdge& edge) {
  const Eigen::Vector3d near_turned = view.R_body_laser * edge.near_laser;
  const Eigen::Vector3d past_turned = view.R_body_laser * edge.past_laser;
  const Eigen::Vector3d near_world = edge.T_world_near * Eigen::Vector3d(near_turned + view.t_body_laser);
  const Eigen::Vector3d past_world = edge.T_world_past * Eigen::Vector3d(past_turned + view.t_body_laser);
  const Eigen::Vector3d edge_world = 0.5 * (near_world + past_world);
  const Eigen::Vector3d p_camera = view.poses.now * edge_world;
  const auto pixel = scene.camera.project(p_camera);
  const auto near_pixel = scene.camera.projectUnbounded(view.poses.now * near_world);
  const auto past_pixel = scene.camera.projectUnbounded(view.poses.now * past_world);
  if (!pixel || !near_pixel || !past_pixel) return std::nullopt;
  const Eigen::Vector2d across = *past_pixel - *near_pixel;
  const double spacing = across.norm();
  if (!(spacing > kLeastSpacing && spacing < kMostSpacing)) return std::nullopt;
  PredictedEdge predicted{.pixel = *pixel, .along = across / spacing, .spacing_px = spacing, .jacobian = {}};
  const Eigen::Matrix3d R_near = edge.T_world_near.matrix(), R_past = edge.T_world_past.matrix();
  Eigen::Matrix<double, 3, 6> d_world;
  d_world.leftCols<3>() = -0.5 * (R_near * skew(near_turned) + R_past * skew(past_turned));
  d_world.rightCols<3>() = 0.5 * (R_near + R_past);
  const Eigen::Matrix<double, 2, 3> lens = scene.camera.jacobian(p_camera);
  predicted.jacobian.leftCols<6>() = lens * view.poses.now.matrix() * d_world;
  const Eigen::Vector3d moved = view.poses.later * edge_world - view.poses.earlier * edge_world;
  predicted.jacobian.col(6) = lens * moved / (2.0 * kTimeStep);
  return predicted;
}

EdgeMatch matchOf(const PredictedEdge& predicted, const ThermalEdges& thermal, const AlignmentLevel& level) {
  EdgeMatch match;
  match.in_view = true;
  const auto edge = thermal.nearest(predicted.pixel, predicted.along, level.radius_px);
  if (!edge) return match;
  match.matched = true;
  match.residual_px = edge->normal.dot(predicted.pixel - edge->pixel);
  const double spread = predicted.spacing_px * edge->normal.dot(predicted.along);
  match.sigma_px = std::sqrt(spread * spread / 12.0 + edge->sigma_px * edge->sigma_px +
                             kPlaceSigma * kPlaceSigma + level.softness_px * level.softness_px);
  match.jacobian = edge->normal.transpose() * predicted.jacobian;
  return match;
}

double scaledSquare(const EdgeMatch& match) {
  const double e = match.residual_px / (kCostScale * match.sigma_px);
  return e * e;
}

/// Rotations put one after the other; the rest adds up.
EdgeChange plus(const EdgeChange& change, const EdgeChange& step) {
  EdgeChange sum = change + step;
  const Eigen::AngleAxisd turn(expRotation(step.head<3>()) * expRotation(change.head<3>()));
  sum.head<3>() = turn.angle() * turn.axis();
  return sum;
}

}  // namespace

std::vector<ThermalEdges> thermalEdgesOf(const ThermalImage& image, double netd) {
  std::vector<ThermalEdges> edges;
  for (const AlignmentLevel& level : kAlignmentLevels)
    edges.emplace_back(image, ThermalEdges::Options{.smoothing_px = level.smoothing_px, .netd = netd});
  return edges;
}

Pose changedPose(const Pose& T_body_laser, const EdgeChange& change) {
  return {(expRotation(change.head<3>()) * T_body_laser.rotation).normalized(),
          T_body_laser.translation + change.segment<3>(3)};
}

std::optional<PredictedEdge> predictedEdge(const EdgeScene& scene, const EdgeFrame& frame,
                                           const PlacedEdge& edge, const EdgeChange& change) {
  const auto view = viewOf(scene, frame, change);
  return view ? predict(scene, *view, edge) : std::nullopt;
}

double EdgeMatch::cost() const {
  if (!matched) return 1.0;
  const double square = scaledSquare(*this);
  return square / (1.0 + square);
}

double EdgeMatch::weight() const {
  const double root = 1.0 / (1.0 + scaledSquare(*this));
  return root * root;
}

std::vector<EdgeMatch> matchEdges(const EdgeScene& scene, const EdgeFrame& frame, const EdgeChange& change,
                                  std::size_t level) {
  std::vector<EdgeMatch> matches(frame.edges.size());
  const auto view = viewOf(scene, frame, change);
  if (!view) return matches;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const auto predicted = predict(scene, *view, frame.edges[i]);
    if (predicted) matches[i] = matchOf(*predicted, frame.thermal[level], kAlignmentLevels[level]);
  }
  return matches;
}

EdgeTerms edgeTerms(std::span<const EdgeMatch> matches) {
  EdgeTerms terms;
  for (const EdgeMatch& match : matches) {
    if (!match.matched) continue;
    const double weight = match.weight() / (match.sigma_px * match.sigma_px);
    terms.information.noalias() += weight * match.jacobian.transpose() * match.jacobian;
    terms.gradient.noalias() += weight * match.residual_px * match.jacobian.transpose();
  }
  return terms;
}

EdgeChange alignEdges(const EdgeScene& scene, const AlignmentModel& model, const EdgeChange& start,
                      std::size_t first_level, std::span<const char> used) {
  // What a step of it moves in the image is of no account.
  const EdgeChange small = (EdgeChange() << 2e-5, 2e-5, 2e-5, 1e-4, 1e-4, 1e-4, 2e-5).finished();
  EdgeChange change = start;
  for (std::size_t level = first_level; level < kAlignmentLevels.size(); ++level) {
    for (int step = 0; step < kMostSteps; ++step) {
      EdgeTerms sum;
      for (std::size_t i = 0; i < scene.frames.size(); ++i) {
        if (used[i] != 0) sum += edgeTerms(matchEdges(scene, scene.frames[i], change, level));
      }
      const EdgeMatrix information = sum.information / model.inflation + model.prior_information;
      const EdgeChange gradient = sum.gradient / model.inflation + model.prior_information * change;
      const EdgeChange move = -information.ldlt().solve(gradient);
      change = plus(change, move);
      if ((move.cwiseAbs().array() < small.array()).all()) break;
    }
  }
  return change;
}

}  // namespace thermovox
