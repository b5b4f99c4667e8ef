#include "mapping/blob_location.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kLeastCosine = 0.1;           // between ray and normal: beyond 84 degrees nothing is located
constexpr double kPixelVariance = 1.0 / 12.0;  // of a place within a pixel, px^2
constexpr std::size_t kFewestPixels = 9;
constexpr int kFewestAcross = 3;

struct Pixel {
  int u, v;
};
using Pixels = std::vector<Pixel>;

/// The pixels from a temperature on, in pieces that touch; row by row.
class Flood {
 public:
  Flood(const ThermalImage& image, double above)
      : image_(image), above_(above), taken_(image.celsius.size()) {}

  std::vector<Pixels> pieces() {
    std::vector<Pixels> pieces;
    for (int v = 0; v < image_.height; ++v) {
      for (int u = 0; u < image_.width; ++u) {
        if (take(u, v)) pieces.push_back(grown({u, v}));
      }
    }
    return pieces;
  }

 private:
  /// Whether a pixel is one more of what is hot.
  bool take(int u, int v) {
    if (u < 0 || v < 0 || u >= image_.width || v >= image_.height) return false;
    const auto place =
        static_cast<std::size_t>(v) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(u);
    if (taken_[place] || !(image_.at(u, v) >= above_)) return false;
    taken_[place] = true;
    return true;
  }

  Pixels grown(Pixel seed) {
    Pixels piece{seed};
    for (std::size_t next = 0; next < piece.size(); ++next) {
      const Pixel from = piece[next];
      for (int i = 0; i < 9; ++i) {
        const Pixel to{from.u + i % 3 - 1, from.v + i / 3 - 1};
        if (take(to.u, to.v)) piece.push_back(to);
      }
    }
    std::sort(piece.begin(), piece.end(),
              [](const Pixel& a, const Pixel& b) { return a.v != b.v ? a.v < b.v : a.u < b.u; });
    return piece;
  }

  const ThermalImage& image_;
  double above_;
  std::vector<bool> taken_;
};

bool isNarrow(const Pixels& pixels) {
  const auto [left, right] = std::minmax_element(pixels.begin(), pixels.end(),
                                                 [](const Pixel& a, const Pixel& b) { return a.u < b.u; });
  return right->u - left->u + 1 < kFewestAcross || pixels.back().v - pixels.front().v + 1 < kFewestAcross;
}

/// Centroid and its covariance: the noise of a pixel moves it by (pixel - centroid) / sum of the weights, and
/// each pixel stands for what is anywhere within it.
void describe(const ThermalImage& image, const Pixels& pixels, double above, const ThermalCamera& camera,
              ThermalBlob& blob) {
  double sum = 0.0, squares = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  blob.peak = {image.at(pixels.front().u, pixels.front().v), camera.netd};
  for (const Pixel& pixel : pixels) {
    const double celsius = image.at(pixel.u, pixel.v);
    const double weight = std::max(celsius - above, 1e-6);  // pixels of the very temperature count alike
    first += weight * Eigen::Vector2d(pixel.u, pixel.v);
    sum += weight;
    squares += weight * weight;
    blob.peak.value = std::max(blob.peak.value, celsius);
    blob.mean += celsius / static_cast<double>(pixels.size());
  }
  blob.pixel = first / sum;
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (const Pixel& pixel : pixels) {
    const Eigen::Vector2d off = Eigen::Vector2d(pixel.u, pixel.v) - blob.pixel;
    second += off * off.transpose();
  }
  const double noise = std::min(camera.netd / sum, 1.0 / std::sqrt(static_cast<double>(pixels.size())));
  blob.pixel_covariance =
      noise * noise * second + kPixelVariance * squares / (sum * sum) * Eigen::Matrix2d::Identity();
  blob.pixels = pixels.size();
  blob.reads_low = pixels.size() < kFewestPixels || isNarrow(pixels);
  blob.bias_sigma = camera.bias_sigma;
}

/// A pixel's ray and where it meets the plane, body frame.
struct Sight {
  Eigen::Vector3d d;                 ///< of the ray; 1 along the optical axis
  double depth = 0.0;                ///< along the optical axis, metres
  Eigen::Vector3d p;                 ///< metres
  Eigen::Matrix<double, 3, 2> d_px;  ///< d p / d pixel, metres per pixel
};

class Plane {
 public:
  explicit Plane(const BeamShot& shot) : shot_(shot), h_(shot.hitBody()), n_(shot.planeNormalBody()) {}

  [[nodiscard]] std::optional<Sight> sightOf(const Eigen::Vector2d& pixel) const {
    const ThermalCamera& camera = shot_.camera;
    const std::optional<Eigen::Vector3d> ray = camera.camera.rayFromPixel(pixel);
    if (!ray) return std::nullopt;
    Sight sight;
    sight.d = camera.T_body_camera.rotation * *ray;
    const double across = n_.dot(sight.d);
    if (std::abs(across) < kLeastCosine * sight.d.norm()) return std::nullopt;
    sight.depth = n_.dot(h_ - camera.T_body_camera.translation) / across;
    if (!(sight.depth > 0.0)) return std::nullopt;
    sight.p = camera.T_body_camera.translation + sight.depth * sight.d;
    // d ray / d pixel is the inverse of the projection's derivative at depth 1; along the plane it stays.
    Eigen::Matrix<double, 3, 2> d_ray = Eigen::Matrix<double, 3, 2>::Zero();
    d_ray.topRows<2>() = Eigen::Matrix2d(camera.camera.jacobian(*ray).leftCols<2>()).inverse();
    const Eigen::Matrix3d onto = Eigen::Matrix3d::Identity() - sight.d * n_.transpose() / across;
    sight.d_px = sight.depth * onto * camera.T_body_camera.matrix() * d_ray;
    return sight;
  }

  [[nodiscard]] std::optional<BlobPlace> placeOf(const ThermalBlob& blob, const Pixels& pixels) const {
    const std::optional<Sight> sight = sightOf(blob.pixel);
    if (!sight) return std::nullopt;
    BlobPlace place{.p_camera = shot_.camera.T_body_camera.inverse() * sight->p, .p_body = sight->p};
    const Laser& beam = shot_.beam;
    const Eigen::Vector3d b = beam.T_body_laser.rotation * Eigen::Vector3d::UnitX();
    const double across = n_.dot(sight->d);
    const double by_range = n_.dot(b) / across;
    const Eigen::Matrix3d along = sight->d * sight->d.transpose();
    place.random = sight->d_px * blob.pixel_covariance * sight->d_px.transpose() +
                   std::pow(by_range * beam.range_sigma, 2) * along;
    Vector6d by_mounting;
    by_mounting << (h_ - beam.T_body_laser.translation).cross(n_), n_;
    if (!shot_.normal_body) by_mounting.head<3>() -= n_.cross(sight->p - h_);
    by_mounting /= across;
    const double mounting = by_mounting.dot(beam.covariance_body_laser * by_mounting);
    place.common = (std::pow(by_range * beam.range_bias_sigma, 2) + mounting) * along;
    for (const Pixel& pixel : pixels) {
      const auto seen = sightOf({pixel.u, pixel.v});
      if (seen) place.area += seen->d_px.col(0).cross(seen->d_px.col(1)).norm();
    }
    return place;
  }

 private:
  const BeamShot& shot_;
  Eigen::Vector3d h_, n_;
};

void checkSize(const ThermalImage& image, const Camera& camera) {
  if (image.width == camera.width() && image.height == camera.height()) return;
  std::ostringstream message;
  message << "has " << image.width << " x " << image.height << " pixels, expected " << camera.width() << " x "
          << camera.height() << " as the rig's thermal camera";
  throw DataError(message.str());
}

}  // namespace

Eigen::Vector3d BeamShot::hitBody() const {
  return beam.T_body_laser * Eigen::Vector3d(range, 0.0, 0.0);
}

Eigen::Vector3d BeamShot::planeNormalBody() const {
  return normal_body ? *normal_body : beam.T_body_laser.rotation * Eigen::Vector3d::UnitX();
}

void BeamShot::validate() const {
  if (beam.kind != LaserKind::beam) throw ConfigError("the laser is no beam, expected one of kind beam");
  if (normal_body && !(std::abs(normal_body->norm() - 1.0) < 1e-6))
    throw ConfigError("the surface's normal is no unit vector");
  if (range > 0.0 && range >= beam.range_min && range <= beam.range_max) return;
  std::ostringstream message;
  message << "the range is " << range << " m, expected one that the beam measures, " << beam.range_min
          << " to " << beam.range_max << " m";
  throw DataError(message.str());
}

std::vector<ThermalBlob> locateBlobs(const ThermalImage& image, double above, const BeamShot& shot) {
  shot.validate();
  checkSize(image, shot.camera.camera);
  const Plane plane(shot);
  std::vector<ThermalBlob> blobs;
  for (const Pixels& pixels : Flood(image, above).pieces()) {
    ThermalBlob& blob = blobs.emplace_back();
    describe(image, pixels, above, shot.camera, blob);
    blob.place = plane.placeOf(blob, pixels);
  }
  std::stable_sort(blobs.begin(), blobs.end(),
                   [](const ThermalBlob& a, const ThermalBlob& b) { return a.peak.value > b.peak.value; });
  return blobs;
}

}  // namespace thermovox
