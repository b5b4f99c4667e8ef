#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mapping/hotspot.hpp"
#include "mapping/surface_blur.hpp"

namespace thermovox {

/// A temperature at a place, for the fit of a peak.
struct PeakSample {
  Eigen::Vector3d p_world;  ///< metres
  double celsius;
  double sigma;               ///< of the temperature, C
  std::uint32_t returns = 0;  ///< of lasers, that the place is the mean of
  SurfaceBlur blur = {};      ///< of the view that it was measured in
};

/// The shape of a small heat source: T(p) = reference + rise exp(-|p - centre|^2 / (2 width^2)). Conduction
/// in a plate makes peaks that are nearly so.
struct PeakModel {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< on the surface, metres
  double rise = 0.0;                                 ///< C
  double width = 0.0;                                ///< one sigma, metres
  double reference = 0.0;                            ///< C

  /// As a camera shows it: convolved with its blur over the surface. With C = width^2 I + blur, of whose
  /// part along the surface the determinant is taken, and d = p - centre,
  ///
  ///   T(p) = reference + rise width^2 / sqrt(det C) exp(-d^T C^-1 d / 2).
  [[nodiscard]] double at(const Eigen::Vector3d& p_world, const SurfaceBlur& blur = {}) const;
};

struct PeakFit {
  PeakModel model;
  /// Of centre x y z (m), ln rise, ln width, reference (C), for the scatter that the samples have about the
  /// model, and for the error of the blur, which all of them share: their sigmas also hold what blur takes
  /// off a slope, the same on all sides of a peak, which the model's width and rise take up.
  Eigen::Matrix<double, 6, 6> covariance;
  /// What it would be if the samples' errors were independent: errors that neighbours share make it wider.
  Eigen::Matrix<double, 6, 6> independent;
  double misfit = 0.0;  ///< robust root mean square of the samples about the model, in their sigmas
};

/// What is known before the fit.
struct PeakPrior {
  PeakModel guess;
  /// Unit normal of the surface through guess.centre, or zero; along it the centre is known to surface_sigma.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double surface_sigma = 0.01;   ///< metres
  double width_sigma = 0.7;      ///< of ln width
  double reference_sigma = 1.0;  ///< C
  double model_error = 0.05;     ///< of the rise: what a real peak differs from the model by, as a sigma
  double blur_sigma = 0.05;      ///< of the blur's width, as a share
};

/// Least squares with a soft L1 loss (Triggs et al., Bundle Adjustment - A Modern Synthesis, 2000) by
/// Levenberg and Marquardt. None where it does not converge, or to no peak: where the centre leaves the
/// samples, or the width falls under a third or grows over three times the guess.
[[nodiscard]] std::optional<PeakFit> fitPeak(std::span<const PeakSample> samples, const PeakPrior& prior);

}  // namespace thermovox
