#include "mapping/surface_layer.hpp"

#include <pcl/kdtree/kdtree_flann.h>

#include <algorithm>
#include <cmath>

#include "mapping/local_plane.hpp"

namespace thermovox {
namespace {

constexpr double kNormalRadius = 2.5;  // cells
constexpr std::size_t kFewest = 6;     // samples that make a plane
constexpr double kPlaneBand = 1.5;     // cells
constexpr float kLeastCosine = 0.8F;   // between the normals of one surface

SurfaceSample sampleOf(const CellKey& key, const SurfaceCell& cell, double resolution) {
  return {key,
          (Eigen::Vector3d(key.x, key.y, key.z) + cell.meanOffset()) * resolution,
          static_cast<float>(cell.mean()),
          static_cast<float>(cell.sigmaOfMean()),
          static_cast<std::uint32_t>(cell.observations),
          static_cast<std::uint32_t>(cell.returns),
          cell.bestView(),
          cell.first(),
          cell.last()};
}

}  // namespace

/// The tree's points are floats, from the first sample on.
struct SurfaceLayer::Search {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
};

SurfaceLayer::SurfaceLayer(const ThermalMap& map)
    : resolution_(map.resolution()), search_(std::make_unique<Search>()) {
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    if (cell.observations > 0) samples_.push_back(sampleOf(key, cell, resolution_));
  });
  normals_.resize(samples_.size());
  if (samples_.empty()) return;
  search_->origin = samples_.front().p_world;
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(samples_.size());
  for (const SurfaceSample& sample : samples_) {
    const Eigen::Vector3f p = (sample.p_world - search_->origin).cast<float>();
    cloud->emplace_back(p.x(), p.y(), p.z());
  }
  search_->tree.setInputCloud(cloud);
}

SurfaceLayer::SurfaceLayer(SurfaceLayer&&) noexcept = default;
SurfaceLayer& SurfaceLayer::operator=(SurfaceLayer&&) noexcept = default;
SurfaceLayer::~SurfaceLayer() = default;

std::vector<std::uint32_t> SurfaceLayer::within(const Eigen::Vector3d& p_world, double radius) const {
  if (samples_.empty()) return {};
  const Eigen::Vector3f p = (p_world - search_->origin).cast<float>();
  pcl::Indices found;
  std::vector<float> squared_distances;
  search_->tree.radiusSearch(pcl::PointXYZ(p.x(), p.y(), p.z()), radius, found, squared_distances);
  std::vector<std::uint32_t> indices(found.begin(), found.end());
  std::sort(indices.begin(), indices.end());
  return indices;
}

const Eigen::Vector3f& SurfaceLayer::normal(std::uint32_t i) const {
  Normal& normal = normals_[i];
  if (normal.known) return normal.direction;
  normal.known = true;
  PointSums sums;
  for (const std::uint32_t j : within(samples_[i].p_world, kNormalRadius * resolution_)) {
    sums.add(samples_[j].p_world - samples_[i].p_world);
  }
  if (sums.count >= kFewest) {
    const LocalPlane plane = localPlane(sums);
    // A line of a scanner is as thin across itself within its plane as off it: no normal follows from it.
    if (plane.width2 > 0.25 * resolution_ * resolution_) normal.direction = plane.normal;
  }
  return normal.direction;
}

bool SurfaceLayer::onSameSurface(std::uint32_t a, std::uint32_t b) const {
  const Eigen::Vector3f& n = normal(a);
  if (n.isZero()) return false;
  const Eigen::Vector3f between = (samples_[b].p_world - samples_[a].p_world).cast<float>();
  if (std::abs(between.dot(n)) > static_cast<float>(kPlaneBand * resolution_)) return false;
  return std::abs(n.dot(normal(b))) > kLeastCosine;
}

}  // namespace thermovox
