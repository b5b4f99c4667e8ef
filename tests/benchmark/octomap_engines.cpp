#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <algorithm>

#include "tests/benchmark/engine.hpp"

namespace thermovox::bench {
namespace {

octomap::point3d octomapPoint(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

/// What is common to OctoMap's trees.
template <typename Tree>
class OctomapEngine : public Engine {
 public:
  explicit OctomapEngine(double resolution) : tree_(resolution) {}

  [[nodiscard]] Cells cells() const override {
    Cells cells;
    for (auto leaf = tree_.begin_leafs(); leaf != tree_.end_leafs(); ++leaf) {
      const double size = std::ldexp(1.0, 3 * static_cast<int>(tree_.getTreeDepth() - leaf.getDepth()));
      cells.known += size;
      if (tree_.isNodeOccupied(*leaf)) cells.surface += size;
    }
    return cells;
  }

 protected:
  Tree tree_;
};

class OctomapRays : public OctomapEngine<octomap::OcTree> {
 public:
  using OctomapEngine::OctomapEngine;
  void insert(std::span<const MappedReturn> scan) override {
    octomap::Pointcloud cloud;
    cloud.reserve(scan.size());
    for (const MappedReturn& ret : scan) cloud.push_back(octomapPoint(ret.p_world));
    tree_.insertPointCloud(cloud, octomapPoint(scan[0].origin_world));
  }
};

class OctomapPoints : public OctomapEngine<octomap::OcTree> {
 public:
  using OctomapEngine::OctomapEngine;
  void insert(std::span<const MappedReturn> scan) override {
    for (const MappedReturn& ret : scan) tree_.updateNode(octomapPoint(ret.p_world), true, true);
  }
};

class ColorOctomapPoints : public OctomapEngine<octomap::ColorOcTree> {
 public:
  using OctomapEngine::OctomapEngine;
  void insert(std::span<const MappedReturn> scan) override {
    for (const MappedReturn& ret : scan) {
      const octomap::OcTreeKey key = tree_.coordToKey(octomapPoint(ret.p_world));
      const auto grey = static_cast<std::uint8_t>(std::clamp(ret.temperature->celsius, 0.0F, 254.0F));
      tree_.updateNode(key, true, true);
      tree_.averageNodeColor(key, grey, grey, grey);
    }
  }
};

}  // namespace

EnginePointer octomapRays(double resolution) {
  return std::make_unique<OctomapRays>(resolution);
}
EnginePointer octomapPoints(double resolution) {
  return std::make_unique<OctomapPoints>(resolution);
}
EnginePointer colorOctomapPoints(double resolution) {
  return std::make_unique<ColorOctomapPoints>(resolution);
}

}  // namespace thermovox::bench
