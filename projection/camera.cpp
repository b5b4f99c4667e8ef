#include "projection/camera.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <string>
#include <unsupported/Eigen/Polynomials>
#include <vector>

#include "projection/error.hpp"

namespace thermovox {
namespace {

using Polynomial = std::vector<double>;  // coefficients, lowest power first

Polynomial multiply(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

Polynomial derivative(const Polynomial& a) {
  Polynomial result;
  for (std::size_t i = 1; i < a.size(); ++i) result.push_back(static_cast<double>(i) * a[i]);
  if (result.empty()) result.push_back(0.0);
  return result;
}

Polynomial sum(Polynomial a, const Polynomial& b, double factor) {
  a.resize(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < b.size(); ++i) a[i] += factor * b[i];
  return a;
}

/// Smallest positive real root of a polynomial whose constant is 1, infinity where there is none. Solved for
/// the reciprocals of the roots: their polynomial has the leading coefficient 1, however small the
/// coefficients of the high powers are.
double smallestPositiveRoot(Polynomial polynomial) {
  // What cannot matter up to a radius of 100 (89.4 degrees off the axis) would only give roots of noise.
  constexpr double kWidest = 1e4;  // radius squared
  const auto negligible = [&] {
    return std::abs(polynomial.back()) * std::pow(kWidest, polynomial.size() - 1) < 1e-12;
  };
  while (polynomial.size() > 1 && negligible()) polynomial.pop_back();
  if (polynomial.size() < 2) return std::numeric_limits<double>::infinity();
  std::reverse(polynomial.begin(), polynomial.end());
  const Eigen::Map<const Eigen::VectorXd> coefficients(polynomial.data(),
                                                       static_cast<Eigen::Index>(polynomial.size()));
  const Eigen::PolynomialSolver<double, Eigen::Dynamic> solver(coefficients);
  double largest = 0.0;
  for (const std::complex<double>& root : solver.roots()) {
    // A double root comes out of the eigenvalues as a pair with a small imaginary part; taking it for real
    // only narrows the field of view by nothing visible.
    const bool real = std::abs(root.imag()) <= 1e-6 * std::abs(root.real());
    if (real) largest = std::max(largest, root.real());
  }
  return 1.0 / largest;
}

/// In s = r^2 the radial map is r N(s) / D(s); it grows where N D + 2 s (N' D - N D') > 0.
double brownConradyRadius(std::span<const double, 8> d) {
  const Polynomial numerator{1.0, d[0], d[1], d[4]};
  const Polynomial denominator{1.0, d[5], d[6], d[7]};
  const Polynomial growth =
      sum(multiply(derivative(numerator), denominator), multiply(numerator, derivative(denominator)), -1.0);
  Polynomial slope = multiply(numerator, denominator);
  slope = sum(slope, multiply(Polynomial{0.0, 2.0}, growth), 1.0);
  return std::sqrt(std::min(smallestPositiveRoot(slope), smallestPositiveRoot(denominator)));
}

/// theta_d grows where 1 + 3 k1 t^2 + 5 k2 t^4 + 7 k3 t^6 + 9 k4 t^8 > 0; theta ends at 90 degrees.
double kannalaBrandtRadius(std::span<const double, 8> d) {
  const double squared = smallestPositiveRoot({1.0, 3.0 * d[0], 5.0 * d[1], 7.0 * d[2], 9.0 * d[3]});
  const double theta = std::sqrt(squared);
  return theta < M_PI / 2 ? std::tan(theta) : std::numeric_limits<double>::infinity();
}

void checkIntrinsics(const Intrinsics& in) {
  if (in.width_px <= 0 || in.height_px <= 0) {
    throw ConfigError("camera: image size is " + std::to_string(in.width_px) + " x " +
                      std::to_string(in.height_px) + ", expected positive");
  }
  if (!std::all_of(in.parameters.begin(), in.parameters.end(), [](double p) { return std::isfinite(p); })) {
    throw ConfigError("camera: a parameter is not a finite number");
  }
  if (!(in.parameters[kFx] > 0.0 && in.parameters[kFy] > 0.0)) {
    throw ConfigError("camera: fx and fy are " + std::to_string(in.parameters[kFx]) + " and " +
                      std::to_string(in.parameters[kFy]) + " px, expected positive");
  }
  const int n = in.distortion_count;
  const bool fits = (in.model == LensModel::pinhole && n == 0) ||
                    (in.model == LensModel::brown_conrady && (n == 4 || n == 5 || n == 8)) ||
                    (in.model == LensModel::kannala_brandt && n == 4);
  if (!fits) {
    throw ConfigError(
        "camera: " + std::to_string(n) +
        " distortion coefficients, expected 0 (pinhole), 4, 5 or 8 (brown_conrady), 4 (kannala_brandt)");
  }
}

std::span<const double, 8> distortionOf(const Intrinsics& intrinsics) {
  return std::span<const double, 8>(intrinsics.parameters.data() + kDistortion, 8);
}

/// Radius that the radial part of the distortion maps to `distorted`, to a few thousandths; by bisection,
/// which the flat end of a strong barrel cannot lead astray.
double undistortedRadius(const Intrinsics& intrinsics, double distorted, double valid_radius) {
  const auto radialMap = [&](double r) {  // the odd part: the tangential coefficients make the even one
    const double* d = intrinsics.parameters.data() + kDistortion;
    return 0.5 * (distort(intrinsics.model, d, Vec2<double>(r, 0.0)).x() -
                  distort(intrinsics.model, d, Vec2<double>(-r, 0.0)).x());
  };
  double low = 0.0;
  double high = std::min(1.0, valid_radius);
  while (high < valid_radius && high < 1e6 && radialMap(high) < distorted) {
    low = high;
    high = std::min(2.0 * high, valid_radius);
  }
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (low + high);
    (radialMap(middle) < distorted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

MaybePixel pixelOf(const LensNumbers& lens, const Eigen::Vector3d& p_camera) {
  return withLensModel(lens.model, [&](auto model) {
    return pixelOf<model.value>(lens, p_camera.x(), p_camera.y(), p_camera.z());
  });
}

}  // namespace

double monotonicRadius(LensModel model, std::span<const double, 8> d) {
  switch (model) {
    case LensModel::brown_conrady:
      return brownConradyRadius(d);
    case LensModel::kannala_brandt:
      return kannalaBrandtRadius(d);
    case LensModel::pinhole:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

Eigen::Matrix2d distortionJacobian(LensModel model, std::span<const double, 8> d, const Eigen::Vector2d& n) {
  return withLensModel(model, [&](auto lens) -> Eigen::Matrix2d {
    const Symmetric2<double> j = distortionJacobianBy<lens.value>(d.data(), n.x(), n.y());
    Eigen::Matrix2d jacobian;
    jacobian << j.xx, j.xy, j.xy, j.yy;
    return jacobian;
  });
}

Camera::Camera(const Intrinsics& intrinsics) : intrinsics_(intrinsics) {
  checkIntrinsics(intrinsics_);
  valid_radius_ = monotonicRadius(intrinsics_.model, distortionOf(intrinsics_));
  numbers_ = {.model = intrinsics_.model,
              .parameters = intrinsics_.parameters,
              .valid_radius_squared = valid_radius_ * valid_radius_,
              .width_px = static_cast<double>(width()),
              .height_px = static_cast<double>(height())};
}

std::optional<Eigen::Vector2d> Camera::projectUnbounded(const Eigen::Vector3d& p_camera) const {
  const MaybePixel pixel = pixelOf(numbers_, p_camera);
  if (!pixel.valid) return std::nullopt;
  return Eigen::Vector2d(pixel.u, pixel.v);
}

std::optional<Eigen::Vector2d> Camera::project(const Eigen::Vector3d& p_camera) const {
  const MaybePixel pixel = pixelOf(numbers_, p_camera);
  if (!pixel.inside) return std::nullopt;
  return Eigen::Vector2d(pixel.u, pixel.v);
}

std::optional<Eigen::Vector3d> Camera::rayFromPixel(const Eigen::Vector2d& pixel) const {
  const auto& p = intrinsics_.parameters;
  const Eigen::Vector2d target((pixel.x() - p[kCx]) / p[kFx], (pixel.y() - p[kCy]) / p[kFy]);
  if (!target.allFinite()) return std::nullopt;
  const auto residual = [&](const Eigen::Vector2d& n) -> Eigen::Vector2d {
    return distort(intrinsics_.model, p.data() + kDistortion, n) - target;
  };
  Eigen::Vector2d n =
      target.stableNormalized() * undistortedRadius(intrinsics_, target.norm(), valid_radius_);
  Eigen::Vector2d error = residual(n);
  constexpr int kMaxIterations = 50;
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::Vector2d step =
        distortionJacobian(intrinsics_.model, distortionOf(intrinsics_), n).inverse() * error;
    // Stay on the monotonic branch (over its border would be the folded image of another ray), and get
    // nearer: where the lens compresses strongly a full step jumps over the root.
    const auto worse = [&] {
      return (n - step).norm() >= valid_radius_ || !(residual(n - step).norm() <= error.norm());
    };
    while (step.norm() > 1e-15 && worse()) step *= 0.5;
    n -= step;
    if (!n.allFinite()) return std::nullopt;
    error = residual(n);
    if (step.norm() < 1e-14 * (1.0 + n.norm())) break;
  }
  if (!(error.norm() < 1e-10)) return std::nullopt;
  return Eigen::Vector3d(n.x(), n.y(), 1.0);
}

Eigen::Matrix<double, 2, 3> Camera::jacobian(const Eigen::Vector3d& p_camera) const {
  const double inverse_depth = 1.0 / p_camera.z();
  const Eigen::Vector2d n = p_camera.head<2>() * inverse_depth;
  Eigen::Matrix<double, 2, 3> normalise;  // d n / d p_camera
  normalise << inverse_depth, 0.0, -n.x() * inverse_depth, 0.0, inverse_depth, -n.y() * inverse_depth;
  const Eigen::Vector2d focal(fx(), fy());
  return focal.asDiagonal() * distortionJacobian(intrinsics_.model, distortionOf(intrinsics_), n) * normalise;
}

}  // namespace thermovox
