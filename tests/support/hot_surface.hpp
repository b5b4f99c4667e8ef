#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "mapping/thermal_map.hpp"

namespace thermovox::test {

/// A small heat source: so much over its surroundings at its centre, a Gaussian of this width (one sigma).
struct HotPeak {
  Eigen::Vector3d centre;  ///< metres
  double rise;             ///< C
  double width;            ///< metres
};

[[nodiscard]] inline double riseAt(const std::vector<HotPeak>& peaks, const Eigen::Vector3d& p) {
  double rise = 0.0;
  for (const HotPeak& peak : peaks) {
    rise += peak.rise * std::exp(-(p - peak.centre).squaredNorm() / (2.0 * peak.width * peak.width));
  }
  return rise;
}

/// How a surface is measured.
struct SurfaceNoise {
  unsigned seed = 1;
  double celsius = 0.1;  ///< one sigma of a temperature
  double range = 0.002;  ///< one sigma of a place along the normal, metres
  Time start = Time(std::chrono::seconds(1000));
};

/// A piece of plane: origin + u along + v across, u and v in [0, edge], seen from 3 m along its normal.
struct PlanePatch {
  Eigen::Vector3d origin = {0.0, 0.0, 1.02};  ///< not on a border of the cells
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();
  Eigen::Vector3d across = Eigen::Vector3d::UnitY();
  double length = 1.5;      ///< along, metres
  double width = 1.5;       ///< across, metres
  double step = 0.02;       ///< from return to return along, metres
  double line_step = 0.02;  ///< from line to line across, metres

  [[nodiscard]] Eigen::Vector3d normal() const { return along.cross(across); }
  [[nodiscard]] Eigen::Vector3d at(double u, double v) const { return origin + u * along + v * across; }
};

/// Temperature at a place, C; NaN: nobody saw it.
using CelsiusAt = std::function<double(const Eigen::Vector3d&)>;

/// The returns of a patch, line by line.
[[nodiscard]] inline std::vector<MappedReturn> returnsOf(const PlanePatch& patch, const CelsiusAt& celsius,
                                                         const SurfaceNoise& noise = {}) {
  std::mt19937_64 random(noise.seed);
  std::normal_distribution<double> normal;
  std::vector<MappedReturn> returns;
  for (double v = 0.5 * patch.line_step; v < patch.width; v += patch.line_step) {
    for (double u = 0.5 * patch.step; u < patch.length; u += patch.step) {
      const Eigen::Vector3d p = patch.at(u, v);
      MappedReturn one{p + noise.range * normal(random) * patch.normal(), p + 3.0 * patch.normal(),
                       noise.start + std::chrono::milliseconds(returns.size()), std::nullopt};
      const double c = celsius(p);
      if (!std::isnan(c)) {
        one.temperature =
            TemperatureObservation{static_cast<float>(c + noise.celsius * normal(random)),
                                   static_cast<float>(std::max(noise.celsius, 0.02)), 3.0F, 0.0F};
      }
      returns.push_back(one);
    }
  }
  return returns;
}

/// A map with cells of 5 cm of these returns.
[[nodiscard]] inline ThermalMap mapOf(const std::vector<MappedReturn>& returns, double resolution = 0.05) {
  ThermalMap map({.resolution = resolution});
  map.integrate(returns, Carving::none);
  return map;
}

/// A plate of 20 C with peaks on it.
[[nodiscard]] inline ThermalMap plateWith(const std::vector<HotPeak>& peaks, const SurfaceNoise& noise = {},
                                          const PlanePatch& patch = {}, double celsius = 20.0) {
  return mapOf(returnsOf(
      patch, [&](const Eigen::Vector3d& p) { return celsius + riseAt(peaks, p); }, noise));
}

}  // namespace thermovox::test
