#include "mapping/painting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "projection/colouring_batch.hpp"

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
  const PackedCovariance covariance = variance * Eigen::Matrix3d::Identity();
  std::vector<const SceneSurface*> surfaces;
  std::vector<PlacedReturn> points;
  for (const SceneView::Seen& seen : scene_view.surfaces()) {
    const Eigen::Vector3d& p_world = seen.surface.p_world;
    const double distance = (p_world - seen.sight.camera_world).norm();
    if (distance > range) continue;
    surfaces.push_back(&seen.surface);
    points.push_back({.stamp = view.frame.stamp,
                      .p_world = p_world,
                      .origin_world = seen.sight.camera_world,
                      .range = distance,
                      .rig_covariance = covariance});
  }
  ColouringBatch batch;
  const std::span<const PointColour> colours = batch.colour(points, {view, camera, scene_view});
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (colours[i].outcome != PointColour::Outcome::coloured) continue;
    const TemperatureObservation observation{
        .celsius = colours[i].celsius,
        .sigma = colours[i].sigma,
        .range = colours[i].range,
        .incidence = incidenceOf(*surfaces[i], view.T_world_camera.translation)};
    map.observe(surfaces[i]->key, observation, view.frame.stamp);
  }
}

}  // namespace thermovox
