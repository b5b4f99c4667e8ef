#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapping/surface_cell.hpp"
#include "projection/time.hpp"

namespace thermovox {

/// What makes a cell hot. With both, either is enough.
struct HotspotCriteria {
  std::optional<double> above;         ///< Celsius, absolute
  std::optional<double> delta = 10.0;  ///< Celsius over the surroundings on the same surface
  void validate() const;               ///< throws ConfigError when there is none, or one is not finite
};

/// An estimate with what it may be wrong by.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;  ///< one standard deviation
};

/// A place in a thermal frame.
struct SeenInFrame {
  Time stamp;             ///< of the frame
  Eigen::Vector2d pixel;  ///< (u, v)
};

/// Where the error of a hot spot's position comes from, world frame, m^2.
struct HotspotPosition {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< of the peak, metres
  Eigen::Matrix3d random = Eigen::Matrix3d::Zero();   ///< noise of ranges and temperatures, and of the fit
  /// Extrinsics, range bias and pose: more measurements of one mission do not shrink it.
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();
  [[nodiscard]] Eigen::Matrix3d covariance() const { return random + common; }
};

/// A place that is hotter than it should be, as one mission saw it.
struct Hotspot {
  HotspotPosition position;
  Estimate peak;              ///< C; what blur and cells take off is put back where the fit allows
  double bias_sigma = 0.0;    ///< of the camera, C: common to all temperatures, not in the estimates' sigmas
  double shape_sigma = 0.0;   ///< of peak and delta, C: what a real peak differs from the model by, likewise
  double hottest_cell = 0.0;  ///< C, as the map holds it
  double p95 = 0.0;           ///< C, 95th percentile of the cells
  double mean = 0.0;          ///< C, of the cells
  Estimate reference;         ///< C, of the surroundings on the same surface
  Estimate delta;             ///< C, peak over reference; the camera's bias cancels
  double width = 0.0;         ///< one sigma of the peak's shape, metres; 0 where it could not be fitted
  double area = 0.0;          ///< m^2, of the surface that its cells cover
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();  ///< of the cells, along the axes, metres
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface, sign arbitrary; zero: unknown
  std::vector<CellKey> cells;
  std::uint64_t observations = 0;
  SurfaceCell::View best_view{};                        ///< of its cells: the one with the most pixels
  Eigen::Vector3d best_seen = Eigen::Vector3d::Zero();  ///< p_world of the cell with this view, metres
  double pixels = 0.0;                                  ///< of the best view, on the spot's cells
  std::optional<SeenInFrame> best_frame;
  bool is_bound = false;  ///< the peak may be higher: under 3 x 3 pixels, or wider blur than can be put back
  Time first_seen;
  Time last_seen;

  /// Of the peak, with all that is not in its own sigma, C.
  [[nodiscard]] double peakSigma() const;
  /// Of the delta likewise, C: the camera's bias cancels.
  [[nodiscard]] double deltaSigma() const;
  /// Whether cells read low here and what was put back is not known to 2 C (two sigmas, the camera's bias
  /// apart), or is a bound.
  [[nodiscard]] bool readsLow() const;
};

}  // namespace thermovox
