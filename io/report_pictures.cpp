#include "io/report_pictures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "io/picture_canvas.hpp"

namespace thermovox {
namespace {

constexpr int kSpotPx = 300;
constexpr Rgb kNothing{226, 229, 233};
constexpr double kCovered = 0.9;  ///< radius of what a cell covers, in edges
constexpr double kBlend = 1.4;    ///< radius within which it counts, in edges
constexpr double kLayer = 2.5;    ///< cells that lie deeper than this many edges are hidden

/// Right, down and forward of a level picture along -normal.
Eigen::Matrix3d axesOf(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d forward = -normal;
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  if (std::abs(normal.z()) < 0.95) {
    right = forward.cross(Eigen::Vector3d::UnitZ());
  } else {
    right -= right.dot(forward) * forward;
  }
  right.normalize();
  Eigen::Matrix3d axes;
  axes << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  return axes;
}

/// A cell as the picture has it.
struct Dot {
  double u = 0.0;
  double v = 0.0;
  double depth = 0.0;  ///< metres, grows away from the viewer
  float celsius = 0.0F;
};

/// Calls visit(pixel's index, squared distance in px) for all pixels within `radius` px of a dot.
template <typename Visitor>
void forEachPixelNear(const Dot& dot, double radius, Visitor&& visit) {
  const int first_u = std::max(0, static_cast<int>(std::ceil(dot.u - radius)));
  const int last_u = std::min(kSpotPx - 1, static_cast<int>(std::floor(dot.u + radius)));
  const int first_v = std::max(0, static_cast<int>(std::ceil(dot.v - radius)));
  const int last_v = std::min(kSpotPx - 1, static_cast<int>(std::floor(dot.v + radius)));
  for (int v = first_v; v <= last_v; ++v) {
    for (int u = first_u; u <= last_u; ++u) {
      const double square = (u - dot.u) * (u - dot.u) + (v - dot.v) * (v - dot.v);
      if (square <= radius * radius) visit(static_cast<std::size_t>(v * kSpotPx + u), square);
    }
  }
}

/// Temperatures of the pixels; NaN where nothing is. `edge`: of a cell, px.
std::vector<float> temperaturesOf(const std::vector<Dot>& dots, double edge, double resolution) {
  constexpr std::size_t kPixels = static_cast<std::size_t>(kSpotPx) * kSpotPx;
  std::vector<double> foremost(kPixels, std::numeric_limits<double>::infinity());
  for (const Dot& dot : dots) {
    forEachPixelNear(dot, kCovered * edge,
                     [&](std::size_t i, double) { foremost[i] = std::min(foremost[i], dot.depth); });
  }
  std::vector<double> sum(kPixels), weights(kPixels);
  for (const Dot& dot : dots) {
    const double radius = kBlend * edge;
    forEachPixelNear(dot, radius, [&](std::size_t i, double square) {
      if (dot.depth > foremost[i] + kLayer * resolution) return;
      const double nearness = 1.0 - square / (radius * radius);
      const double weight = nearness * nearness;
      sum[i] += weight * dot.celsius;
      weights[i] += weight;
    });
  }
  std::vector<float> celsius(kPixels, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (std::isfinite(foremost[i]) && weights[i] > 0.0) celsius[i] = static_cast<float>(sum[i] / weights[i]);
  }
  return celsius;
}

ReportPicture paint(const std::vector<float>& celsius, const Hotspot& spot) {
  ReportPicture picture{{}, kSpotPx, kSpotPx, {}};
  picture.scale.span = {spot.reference.value - 5.0, spot.hottest_cell};
  if (const auto measured = percentileSpan(celsius, 1.0, 100.0)) picture.scale.span = *measured;
  if (!(picture.scale.span.low < picture.scale.span.high)) {
    picture.scale.span.high = picture.scale.span.low + 1.0;
  }
  cv::Mat bgr(kSpotPx, kSpotPx, CV_8UC3);
  for (std::size_t i = 0; i < celsius.size(); ++i) {
    const Rgb colour = std::isnan(celsius[i]) ? kNothing : picture.scale.colourOf(celsius[i]);
    bgr.at<cv::Vec3b>(static_cast<int>(i) / kSpotPx, static_cast<int>(i) % kSpotPx) = {colour.b, colour.g,
                                                                                       colour.r};
  }
  picture.png = pngOf(bgr);
  return picture;
}

}  // namespace

ReportPicture pictureOf(const MapView& drawn) {
  // The rows are read only: cvtColor writes elsewhere.
  const cv::Mat rgb(drawn.picture.height, drawn.picture.width, CV_8UC3,
                    const_cast<std::uint8_t*>(drawn.picture.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return {pngOf(bgr), drawn.picture.width, drawn.picture.height, drawn.scale};
}

SpotPicture drawSpot(const Hotspot& spot, const SurfaceLayer& layer) {
  const double resolution = layer.resolution();
  SpotPicture drawn;
  drawn.along_normal = !spot.normal.isZero();
  drawn.half_width = std::clamp(std::max({0.3, 5.0 * spot.width, 0.75 * spot.extent.maxCoeff()}),
                                6.0 * resolution, 40.0 * resolution);
  const Eigen::Matrix3d axes =
      axesOf(drawn.along_normal ? spot.normal.normalized() : Eigen::Vector3d(-Eigen::Vector3d::UnitY()));
  const double px = kSpotPx / (2.0 * drawn.half_width);  // of a metre
  drawn.px_from_world = px * axes.topRows<2>();
  const double in_front = std::max(0.25, spot.extent.maxCoeff());
  std::vector<Dot> dots;
  for (const std::uint32_t i : layer.within(spot.position.p_world, 1.5 * drawn.half_width)) {
    const Eigen::Vector3d q = axes * (layer[i].p_world - spot.position.p_world);
    if (q.z() < -in_front || q.z() > drawn.half_width) continue;
    dots.push_back(
        {q.x() * px + 0.5 * (kSpotPx - 1), q.y() * px + 0.5 * (kSpotPx - 1), q.z(), layer[i].celsius});
  }
  drawn.picture = paint(temperaturesOf(dots, resolution * px, resolution), spot);
  return drawn;
}

}  // namespace thermovox
