#include "mapping/painting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "projection/colouring.hpp"

namespace thermovox {
namespace {

constexpr double kWidestPixel = 4.0;  // in cells

/// Angle between the line of sight and the surface's normal, radians; NaN where it is not known.
float incidenceOf(const SceneSurface& surface, const Eigen::Vector3d& camera_world) {
  if (surface.normal.isZero()) return std::numeric_limits<float>::quiet_NaN();
  const Eigen::Vector3f to_camera = (camera_world - surface.p_world).cast<float>().normalized();
  return std::acos(std::min(std::abs(surface.normal.dot(to_camera)), 1.0F));
}

}  // namespace

double paintRange(const ThermalCamera& camera, double resolution) {
  return kWidestPixel * resolution * std::min(camera.camera.fx(), camera.camera.fy());
}

void paint(const ThermalView& view, const ThermalCamera& camera, const SceneView& scene_view,
           double range_sigma, ThermalMap& map) {
  const double range = paintRange(camera, map.resolution());
  const double variance = range_sigma * range_sigma + map.resolution() * map.resolution() / 12.0;
  PlacedReturn placed;
  placed.rig_covariance = variance * Eigen::Matrix3d::Identity();
  for (const SceneView::Seen& seen : scene_view.surfaces()) {
    placed.p_world = seen.surface.p_world;
    if ((placed.p_world - seen.sight.camera_world).norm() > range) continue;
    const auto result = colour(placed, view, camera, scene_view);
    const Colour* found = std::get_if<Colour>(&result);
    if (found == nullptr) continue;
    const TemperatureObservation observation{.celsius = found->celsius,
                                             .sigma = found->sigma,
                                             .range = found->range,
                                             .incidence = incidenceOf(seen.surface, seen.sight.camera_world)};
    map.observe(seen.surface.key, observation, view.frame.stamp);
  }
}

}  // namespace thermovox
