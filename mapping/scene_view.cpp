#include "mapping/scene_view.hpp"

#include <algorithm>
#include <cmath>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kBinsAcross = 160.0;
constexpr double kMostBins = 32.0;   // that an obstacle reaches from its middle
constexpr double kStretch = 1.2;     // distortion may spread a disc by this much
constexpr double kFisheye = 1.6;     // theta / sin(theta) up to a right angle
constexpr float kTilt = 0.08F;       // radians that the normal of a disc may be off
constexpr double kFarOutside = 1e6;  // px; keeps conversions to int defined

}  // namespace

void SceneView::Options::validate() const {
  depths.validate();
  if (!(disc_radius > 0.0 && ball_radius > 0.0)) {
    throw ConfigError("disc_radius and ball_radius: expected more than 0 edges");
  }
  if (!(slope > 0.0)) throw ConfigError("slope: expected more than 0");
  if (!(margin >= 0.0 && off_plane >= 0.0)) {
    throw ConfigError("margin and off_plane: expected 0 m or more");
  }
}

SceneView::SceneView(const Camera& camera, const Pose& T_camera_world, SceneSurfaces& scene, double range,
                     const Options& options)
    : camera_(&camera),
      T_camera_world_(T_camera_world),
      camera_world_(T_camera_world.inverse().translation),
      options_(options),
      edge_(scene.resolution()),
      depths_(camera, T_camera_world, options.depths) {
  options_.validate();
  // Coarse cells stand for coarser surfaces.
  options_.margin = std::max(options_.margin, 1.5 * edge_);
  options_.off_plane = std::max(options_.off_plane, 0.5 * edge_);
  bin_px_ = std::max(1.0, std::round(camera.width() / kBinsAcross));
  columns_ = static_cast<int>(std::ceil(camera.width() / bin_px_));
  rows_ = static_cast<int>(std::ceil(camera.height() / bin_px_));
  scene.forEachInView(camera, T_camera_world, range, [&](const SceneSurface& surface) {
    if ((surface.p_world - camera_world_).norm() <= range) add(surface);
  });
  depths_.finish();
  sortIntoBins();
}

double SceneView::pixelRadius(const Eigen::Vector3d& p_camera, double radius) const {
  const double focal_px = std::max(camera_->fx(), camera_->fy());
  const double distance = p_camera.norm();
  if (camera_->intrinsics().model == LensModel::kannala_brandt) {
    return kStretch * kFisheye * focal_px * radius / distance;
  }
  return kStretch * focal_px * radius * distance / (p_camera.z() * p_camera.z());
}

void SceneView::add(const SceneSurface& surface) {
  const Eigen::Vector3d p_camera = T_camera_world_ * surface.p_world;
  const auto pixel = camera_->projectUnbounded(p_camera);
  if (!pixel || !(pixel->cwiseAbs().maxCoeff() < kFarOutside)) return;
  depths_.add(surface.p_world);
  const bool inside = pixel->x() >= -0.5 && pixel->y() >= -0.5 && pixel->x() < camera_->width() - 0.5 &&
                      pixel->y() < camera_->height() - 0.5;
  if (inside) seen_.push_back({surface, {camera_world_, surface.p_world, *pixel, p_camera.z()}});
  const bool disc = !surface.normal.isZero();
  const double radius = edge_ * (disc ? options_.disc_radius : options_.ball_radius);
  const double reach = std::min(pixelRadius(p_camera, radius) / bin_px_, kMostBins);
  const double column = (pixel->x() + 0.5) / bin_px_;
  const double row = (pixel->y() + 0.5) / bin_px_;
  const auto binAt = [](double place) { return static_cast<std::int32_t>(std::floor(place)); };
  const Reach bins{std::max(binAt(column - reach), 0), std::min(binAt(column + reach), columns_ - 1),
                   std::max(binAt(row - reach), 0), std::min(binAt(row + reach), rows_ - 1)};
  if (bins.first_column > bins.last_column || bins.first_row > bins.last_row) return;
  obstacles_.push_back({(surface.p_world - camera_world_).cast<float>(), surface.normal});
  reaches_.push_back(bins);
}

void SceneView::sortIntoBins() {
  const auto forEachBin = [this](const Reach& reach, const auto& visit) {
    for (std::int32_t row = reach.first_row; row <= reach.last_row; ++row) {
      for (std::int32_t column = reach.first_column; column <= reach.last_column; ++column) {
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
              static_cast<std::size_t>(column));
      }
    }
  };
  bin_begin_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const Reach& reach : reaches_) forEachBin(reach, [this](std::size_t bin) { ++bin_begin_[bin + 1]; });
  for (std::size_t bin = 1; bin < bin_begin_.size(); ++bin) bin_begin_[bin] += bin_begin_[bin - 1];
  bin_obstacles_.resize(bin_begin_.back());
  std::vector<std::uint32_t> next(bin_begin_.begin(), bin_begin_.end() - 1);
  for (std::uint32_t i = 0; i < reaches_.size(); ++i) {
    forEachBin(reaches_[i], [&](std::size_t bin) { bin_obstacles_[next[bin]++] = i; });
  }
  reaches_ = {};
}

bool SceneView::hides(const Sight& sight) const {
  return depths_.hides(sight) || passesSurface(sight);
}

bool SceneView::passesSurface(const Sight& sight) const {
  const auto column = static_cast<int>(std::floor((sight.pixel.x() + 0.5) / bin_px_));
  const auto row = static_cast<int>(std::floor((sight.pixel.y() + 0.5) / bin_px_));
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return false;
  const Eigen::Vector3f point = (sight.p_world - camera_world_).cast<float>();
  const float distance = point.norm();
  const Eigen::Vector3f d = point / distance;
  const auto margin = static_cast<float>(options_.margin);
  const auto off_plane = static_cast<float>(options_.off_plane);
  const auto disc = static_cast<float>(options_.disc_radius * edge_);
  const auto ball = static_cast<float>(options_.ball_radius * edge_);
  const auto slope = static_cast<float>(options_.slope);
  const std::size_t bin =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  for (std::uint32_t i = bin_begin_[bin]; i < bin_begin_[bin + 1]; ++i) {
    const Obstacle& obstacle = obstacles_[bin_obstacles_[i]];
    const float ahead = distance - obstacle.place.dot(d);  // metres the obstacle stands before the point
    if (ahead < margin) continue;
    if (obstacle.normal.isZero()) {
      if ((point - ahead * d - obstacle.place).norm() < std::min(ball, ahead / slope)) return true;
      continue;
    }
    const float above = obstacle.normal.dot(point - obstacle.place);
    const float sine = obstacle.normal.dot(d);
    if (std::abs(above) < off_plane + kTilt * ahead || std::abs(sine) < kTilt) continue;
    const float back = above / sine;  // metres from the point to the plane
    if (back < margin || back > distance) continue;
    if ((point - back * d - obstacle.place).norm() < disc) return true;
  }
  return false;
}

}  // namespace thermovox
