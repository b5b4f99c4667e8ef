#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calibration/thermal_edges.hpp"
#include "projection/camera.hpp"
#include "projection/pose.hpp"
#include "projection/trajectory.hpp"

namespace thermovox {

/// A depth edge (depth_edges.hpp) with the body's places when its two beams were taken.
struct PlacedEdge {
  Pose T_world_near;  ///< T_world_body at the near return's stamp
  Pose T_world_past;  ///< and at that of the beam past the edge
  Eigen::Vector3d near_laser;
  Eigen::Vector3d past_laser;
};

/// How sharply images and edges are compared, from coarse to fine.
struct AlignmentLevel {
  double smoothing_px;  ///< of the image, one sigma
  double radius_px;     ///< within which an edge of temperature is looked for
  double softness_px;   ///< beside the edges' own sigma
};
inline constexpr std::array<AlignmentLevel, 3> kAlignmentLevels{
    {{2.5, 10.0, 2.5}, {1.5, 6.0, 1.2}, {1.0, 4.0, 0.3}}};

/// One thermal frame and the depth edges about it.
struct EdgeFrame {
  Time stamp;
  std::vector<ThermalEdges> thermal;  ///< of each level
  std::vector<PlacedEdge> edges;
};

/// The edges of temperature of an image at every level; `netd` as in ThermalEdges::Options.
[[nodiscard]] std::vector<ThermalEdges> thermalEdgesOf(const ThermalImage& image, double netd);

/// What is to be brought together.
struct EdgeScene {
  Camera camera;
  Pose T_body_camera;
  Pose T_body_laser;  ///< where the rig says that it is
  Trajectory trajectory;
  std::vector<EdgeFrame> frames;  ///< in the order of their stamps
};

/// The change of the rig: rotation w (radians) and translation v (metres) of the laser along the body's axes,
/// R' = Exp(w) R, t' = t + v, then what is to be added to the frames' stamps (seconds).
using EdgeChange = Eigen::Matrix<double, 7, 1>;
using EdgeMatrix = Eigen::Matrix<double, 7, 7>;

[[nodiscard]] Pose changedPose(const Pose& T_body_laser, const EdgeChange& change);

/// A depth edge as the camera should see it.
struct PredictedEdge {
  Eigen::Vector2d pixel;
  Eigen::Vector2d along;                 ///< unit, from the nearer surface to what lies behind it
  double spacing_px = 0.0;               ///< from the last beam on the surface to the first one past it
  Eigen::Matrix<double, 2, 7> jacobian;  ///< d pixel / d change
};

/// Where a frame should show one of its edges; nullopt outside the image or the trajectory, and where its two
/// beams are too far apart (or not at all) to say where it is.
[[nodiscard]] std::optional<PredictedEdge> predictedEdge(const EdgeScene& scene, const EdgeFrame& frame,
                                                         const PlacedEdge& edge, const EdgeChange& change);

/// A depth edge against the image.
struct EdgeMatch {
  bool in_view = false;
  bool matched = false;      ///< with an edge of temperature; what follows is of that
  double residual_px = 0.0;  ///< across the edge of temperature
  double sigma_px = 0.0;     ///< softness included
  Eigen::Matrix<double, 1, 7> jacobian;

  /// Half a cost between 0 and 1 (S. Geman and D. McClure, 1987); 1 without a match.
  [[nodiscard]] double cost() const;
  [[nodiscard]] double weight() const;  ///< of the residual's square
};

/// Of all edges of a frame, in their order.
[[nodiscard]] std::vector<EdgeMatch> matchEdges(const EdgeScene& scene, const EdgeFrame& frame,
                                                const EdgeChange& change, std::size_t level);

/// The normal equations of some edges: J^T W J and J^T W r.
struct EdgeTerms {
  EdgeMatrix information = EdgeMatrix::Zero();
  EdgeChange gradient = EdgeChange::Zero();

  EdgeTerms& operator+=(const EdgeTerms& other) {
    information += other.information;
    gradient += other.gradient;
    return *this;
  }
};
[[nodiscard]] EdgeTerms edgeTerms(std::span<const EdgeMatch> matches);

/// What is known besides the edges.
struct AlignmentModel {
  EdgeMatrix prior_information = EdgeMatrix::Zero();
  /// By how much more the edges err together than each alone: their information is divided by it.
  double inflation = 10.0;
};

/// The least robust cost of edges and prior, from `start`, through the levels from `first_level` on. Frames
/// of which `used` is 0 are left out.
[[nodiscard]] EdgeChange alignEdges(const EdgeScene& scene, const AlignmentModel& model,
                                    const EdgeChange& start, std::size_t first_level,
                                    std::span<const char> used);

}  // namespace thermovox
