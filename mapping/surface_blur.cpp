#include "mapping/surface_blur.hpp"

#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

constexpr double kLeastCosine = 0.2;

}  // namespace

SurfaceBlur surfaceBlur(const Eigen::Vector3d& view, const Eigen::Vector3d& normal, double sigma) {
  const double width = sigma * view.norm();
  SurfaceBlur blur{.variance = width * width};
  if (normal.isZero() || view.isZero()) return blur;
  const Eigen::Vector3d ray = view.normalized();
  const Eigen::Vector3d along = ray - ray.dot(normal) * normal;
  const double sine = along.norm();
  if (!(sine > 1e-6)) return blur;
  const double cosine = std::max(std::abs(ray.dot(normal)), kLeastCosine);
  blur.oblique = along / sine * width * std::sqrt(1.0 / (cosine * cosine) - 1.0);
  return blur;
}

}  // namespace thermovox
