#include "mapping/painting.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "mapping/grazing.hpp"
#include "projection/colouring_batch.hpp"

namespace thermovox {
namespace {

constexpr double kWidestPixel = 4.0;  // in cells

}  // namespace

double paintRange(const ThermalCamera& camera, double resolution) {
  return kWidestPixel * resolution * std::min(camera.camera.fx(), camera.camera.fy());
}

std::size_t paint(const ThermalView& view, const ThermalCamera& camera, const SceneView& scene_view,
                  const PaintOptions& options, ThermalMap& map) {
  const double range = paintRange(camera, map.resolution());
  const double variance =
      options.range_sigma * options.range_sigma + map.resolution() * map.resolution() / 12.0;
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
  const double reflected = reflectedTemperature(*view.frame.image, options.ambient);
  std::size_t uncalibrated = 0;
  ColouringBatch batch;
  const std::span<const PointColour> colours = batch.colour(points, {view, camera, scene_view});
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (colours[i].outcome != PointColour::Outcome::coloured) continue;
    const SceneSurface& surface = *surfaces[i];
    const GrazingView grazing = grazingView(trustedNormal(surface, options.range_sigma),
                                            {surface.p_world, colours[i].celsius}, view, reflected);
    const TemperatureObservation observation{.celsius = colours[i].celsius,
                                             .sigma = colours[i].sigma,
                                             .range = colours[i].range,
                                             .incidence = grazing.incidence,
                                             .common_sigma = grazing.sigma};
    map.observe(surfaces[i]->key, observation, view.frame.stamp);
    const auto& calibrated = view.frame.image->calibrated_range;
    if (calibrated && (calibrated->isBelow(observation.celsius) || calibrated->isAbove(observation.celsius)))
      ++uncalibrated;
  }
  return uncalibrated;
}

}  // namespace thermovox
