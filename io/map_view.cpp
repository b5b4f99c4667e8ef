#include "io/map_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "io/surface_normals.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr int kOversampling = 2;  // drawn this much larger and averaged down
constexpr Rgb kGeometryColour{156, 160, 166};
// In the half by temperature, what no frame saw.
constexpr Rgb kUnseenColour{74, 77, 82};
constexpr Rgb kUnseenOnWhite{204, 207, 212};
constexpr double kDegree = std::numbers::pi / 180.0;

/// Neighbours within this many cells tell a point's normal and how densely its surface was measured.
constexpr double kNeighbourhood = 2.6;

/// Discs of a densely measured surface just cover it; where it was measured sparsely they grow.
float splatRadius(const LocalSurface& surface, double resolution) {
  const double dense = std::numbers::pi * kNeighbourhood * kNeighbourhood;
  const double growth = std::clamp(std::sqrt(dense / surface.neighbours), 1.0, 2.0);
  return static_cast<float>(0.72 * growth * resolution);
}

/// Box that holds all points but stray ones: between the 0.5th and 99.5th percentile an axis.
struct Extent {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

Extent extentOf(std::span<const SurfacePoint> points) {
  Extent extent;
  std::vector<float> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [axis](const SurfacePoint& point) { return point.p_world[axis]; });
    const TemperatureSpan inner = *percentileSpan(values, 0.5, 99.5);
    extent.low[axis] = inner.low;
    extent.high[axis] = inner.high;
  }
  return extent;
}

/// Unit vector from the map to the viewer.
Eigen::Vector3d towardsViewer(const Extent& extent, const MapPictureOptions& options) {
  const Eigen::Vector3d size = extent.high - extent.low;
  const double turn = size.x() >= size.y() ? 0.0 : 90.0;
  const double azimuth = (options.azimuth_deg + turn) * kDegree;
  const double elevation = options.elevation_deg * kDegree;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// Whether a point stays when the ceiling and the walls towards the viewer are cut away.
bool isShown(const Eigen::Vector3f& p, const Extent& extent, const Eigen::Vector3d& to_viewer,
             double cut_height) {
  constexpr double kWall = 0.3;  // metres: walls are not quite flat and not quite parallel to the axes
  if (p.z() > extent.low.z() + cut_height * (extent.high.z() - extent.low.z())) return false;
  for (int axis = 0; axis < 2; ++axis) {
    if (to_viewer[axis] > 0.0 && p[axis] > extent.high[axis] - kWall) return false;
    if (to_viewer[axis] < 0.0 && p[axis] < extent.low[axis] + kWall) return false;
  }
  for (int axis = 0; axis < 3; ++axis) {  // stray points far out
    if (p[axis] < extent.low[axis] - 1.0 || p[axis] > extent.high[axis] + 1.0) return false;
  }
  return true;
}

/// Looks along -to_viewer, its picture level, far enough off that all splats fit into `frame`.
PictureView viewOf(std::span<const Splat> splats, const Eigen::Vector3d& to_viewer, const cv::Rect& frame,
                   const cv::Size& size) {
  const Eigen::Vector3d forward = -to_viewer;
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R_world_view;
  R_world_view << right, forward.cross(right), forward;
  PictureView view;
  view.T_world_view.rotation = Eigen::Quaterniond(R_world_view).normalized();
  view.width_px = size.width;
  view.height_px = size.height;
  view.center_x_px = frame.x + frame.width / 2.0;
  view.center_y_px = frame.y + frame.height / 2.0;
  view.focal_px = 1.7 * frame.width;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  for (const Splat& splat : splats)
    target += splat.p_world.cast<double>() / static_cast<double>(splats.size());
  double distance = 50.0;
  constexpr int kIterations = 12;
  for (int i = 0; i < kIterations; ++i) {
    view.T_world_view.translation = target + distance * to_viewer;
    Eigen::AlignedBox2d seen;
    const Pose T_view_world = view.T_world_view.inverse();
    for (const Splat& splat : splats) {
      const Eigen::Vector3d p = T_view_world * splat.p_world.cast<double>();
      if (p.z() > 0.1 * distance) seen.extend(Eigen::Vector2d(p.head<2>() / p.z() * view.focal_px));
    }
    const Eigen::Vector2d middle = seen.center() / view.focal_px * distance;
    target += R_world_view.col(0) * middle.x() + R_world_view.col(1) * middle.y();
    distance *= std::max(seen.sizes().x() / frame.width, seen.sizes().y() / frame.height);
  }
  view.T_world_view.translation = target + distance * to_viewer;
  return view;
}

/// Dark, a little lighter in the middle; or white.
RgbPicture backgroundOf(const cv::Size& size, Backdrop backdrop) {
  RgbPicture picture{size.width, size.height, {}};
  if (backdrop == Backdrop::white) {
    picture.rgb.assign(static_cast<std::size_t>(size.area()) * 3, 255);
    return picture;
  }
  picture.rgb.reserve(static_cast<std::size_t>(size.area()) * 3);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const double x = 2.0 * u / size.width - 1.0;
      const double y = 2.0 * v / size.height - 1.0;
      const double light = 1.0 - 0.35 * std::min(1.0, (x * x + y * y) / 2.0);
      for (const double channel : {30.0, 33.0, 38.0}) {
        picture.rgb.push_back(static_cast<std::uint8_t>(std::lround(channel * light)));
      }
    }
  }
  return picture;
}

std::vector<Splat> splatsOf(std::span<const SurfacePoint> points, const Extent& extent,
                            const Eigen::Vector3d& to_viewer, const MapPictureOptions& options,
                            const TemperatureScale& scale) {
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(points.size());
  for (const SurfacePoint& point : points) positions.push_back(point.p_world);
  const std::vector<LocalSurface> surfaces = localSurfaces(positions, kNeighbourhood * options.resolution);
  const Eigen::Vector3d size = extent.high - extent.low;
  const int long_axis = size.x() >= size.y() ? 0 : 1;
  const double middle = (extent.low[long_axis] + extent.high[long_axis]) / 2;
  // The half on the picture's left: where the axis points to the right it is the lower one.
  const Eigen::Vector3d right = (-to_viewer).cross(Eigen::Vector3d::UnitZ());
  const double sign = right[long_axis] > 0.0 ? 1.0 : -1.0;
  std::vector<Splat> splats;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& point = points[i];
    if (!isShown(point.p_world, extent, to_viewer, options.cut_height)) continue;
    const bool grey =
        options.style == PictureStyle::split && sign * (point.p_world[long_axis] - middle) < 0.0;
    Splat splat{point.p_world, surfaces[i].normal, splatRadius(surfaces[i], options.resolution),
                kGeometryColour};
    if (!grey && point.temperature) {
      // In front of neighbours without temperature, which would cover it with grey specks.
      splat.p_world += (0.4 * options.resolution * to_viewer).cast<float>();
      splat.radius *= 1.3F;
      splat.colour = scale.colourOf(point.temperature->celsius);
    } else if (!grey) {
      splat.colour = options.backdrop == Backdrop::white ? kUnseenOnWhite : kUnseenColour;
    }
    splats.push_back(splat);
  }
  return splats;
}

TemperatureScale scaleOf(std::span<const SurfacePoint> points, const MapPictureOptions& options) {
  TemperatureScale scale{{}, options.palette, options.exponent};
  std::vector<float> celsius;
  for (const SurfacePoint& point : points) {
    if (point.temperature) celsius.push_back(point.temperature->celsius);
  }
  if (options.span) {
    scale.span = *options.span;
  } else if (const auto measured = percentileSpan(celsius, 1.0, 99.95)) {
    // A little below the coldest: what is black would be lost before the dark background.
    scale.span = {measured->low - 0.03 * (measured->high - measured->low), measured->high};
  }
  return scale;
}

/// Averaged down to the picture's own size.
RgbPicture smallOf(RgbPicture large, const cv::Size& size) {
  const cv::Mat fine(large.height, large.width, CV_8UC3, large.rgb.data());
  RgbPicture small{size.width, size.height, {}};
  small.rgb.resize(static_cast<std::size_t>(size.area()) * 3);
  cv::Mat coarse(size, CV_8UC3, small.rgb.data());
  cv::resize(fine, coarse, size, 0, 0, cv::INTER_AREA);
  return small;
}

/// The same view in pixels that are kOversampling times as large; whole numbers are their centres.
PictureView smallOf(PictureView view, const cv::Size& size) {
  view.focal_px /= kOversampling;
  view.center_x_px = (view.center_x_px + 0.5) / kOversampling - 0.5;
  view.center_y_px = (view.center_y_px + 0.5) / kOversampling - 0.5;
  view.width_px = size.width;
  view.height_px = size.height;
  return view;
}

}  // namespace

void MapPictureOptions::validate() const {
  const auto require = [](bool good, const char* name, double value, const char* expected) {
    if (!good)
      throw ConfigError(std::string("picture: ") + name + " is " + std::to_string(value) + ", expected " +
                        expected);
  };
  require(resolution > 0.0 && resolution < 100.0, "resolution", resolution, "metres, more than 0");
  require(elevation_deg > 0.0 && elevation_deg < 90.0, "elevation_deg", elevation_deg,
          "more than 0 and less than 90");
  require(std::isfinite(azimuth_deg), "azimuth_deg", azimuth_deg, "a finite angle");
  require(exponent > 0.0 && exponent <= 1.0, "exponent", exponent, "more than 0 and at most 1");
  require(cut_height > 0.0, "cut_height", cut_height, "more than 0");
  require(width_px >= 320 && width_px <= 8000, "width_px", width_px, "320 to 8000");
  require(height_px >= 240 && height_px <= 8000, "height_px", height_px, "240 to 8000");
  if (span) require(span->low < span->high, "span", span->low, "less than its upper end");
}

MapView drawMap(std::span<const SurfacePoint> points, const MapPictureOptions& options) {
  options.validate();
  if (points.empty()) throw DataError("the map holds no surface, expected points to draw");
  const Extent extent = extentOf(points);
  const Eigen::Vector3d to_viewer = towardsViewer(extent, options);
  const TemperatureScale scale = scaleOf(points, options);
  const std::vector<Splat> splats = splatsOf(points, extent, to_viewer, options, scale);
  const cv::Size size(options.width_px, options.height_px);
  const cv::Size large = size * kOversampling;
  const int top = options.backdrop == Backdrop::white ? large.height / 40 : large.height / 8;
  const cv::Rect frame(large.width / 40, top, large.width * 19 / 20, large.height * 39 / 40 - top);
  const PictureView view = viewOf(splats, to_viewer, frame, large);
  RgbPicture picture = drawSplats(splats, view, backgroundOf(large, options.backdrop));
  return {smallOf(std::move(picture), size), smallOf(view, size), scale};
}

}  // namespace thermovox
