#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "projection/thermal_image.hpp"

namespace thermovox {

/// A place on an edge of temperature.
struct ThermalEdge {
  Eigen::Vector2d pixel;
  Eigen::Vector2d normal;  ///< unit, towards the warmer side
  double sigma_px = 0.0;   ///< of its place along the normal, by the noise alone
  double slope = 0.0;      ///< C a pixel, of the smoothed image
};

/// The edges of temperature in an image: where the slope of the image, smoothed by a Gaussian, is largest
/// along its own direction (J. Canny, "A computational approach to edge detection", 1986), to a fraction of a
/// pixel.
class ThermalEdges {
 public:
  struct Options {
    double smoothing_px = 1.0;  ///< one sigma
    double netd = 0.05;         ///< noise of a pixel, C, if the image itself shows no more
    double least_slope = 6.0;   ///< in sigmas of the slope's noise
  };
  ThermalEdges(const ThermalImage& image, const Options& options);

  /// The edge nearest to a pixel, within `radius` and across `along` (a unit vector): its normal is within 60
  /// degrees of it, either way.
  [[nodiscard]] std::optional<ThermalEdge> nearest(const Eigen::Vector2d& pixel, const Eigen::Vector2d& along,
                                                   double radius) const;
  [[nodiscard]] const std::vector<ThermalEdge>& all() const { return edges_; }

 private:
  void sortIntoCells(int width, int height);

  std::vector<ThermalEdge> edges_;  ///< cell by cell
  std::vector<std::size_t> first_;  ///< of each cell, and the end
  int columns_ = 0, rows_ = 0;
};

/// The noise of a pixel as the image shows it, C: by the median of what is left of it without its smooth
/// parts (after J. Immerkaer, "Fast noise variance estimation", 1996). 0 for an image too small to say.
[[nodiscard]] double imageNoise(const ThermalImage& image);

}  // namespace thermovox
