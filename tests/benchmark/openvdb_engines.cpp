// The one file that reads OpenVDB's headers; built where they are found.

#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>
#include <openvdb/openvdb.h>

#include <algorithm>

#include "tests/benchmark/engine.hpp"

namespace thermovox::bench {
namespace {

using Accessor = openvdb::FloatGrid::Accessor;

// OctoMap's defaults, so that the map means the same: natural logarithms of the odds.
constexpr float kHit = 0.8472979F, kMiss = -0.4054651F, kLowest = -1.9924302F, kHighest = 3.5109570F;

void update(Accessor& accessor, const openvdb::Coord& cell, float change) {
  const float log_odds = std::clamp(accessor.getValue(cell) + change, kLowest, kHighest);
  accessor.setValueOn(cell, log_odds);
}

/// A grid of log-odds in which the known cells are active.
class OpenVdbEngine : public Engine {
 public:
  explicit OpenVdbEngine(double resolution)
      : inverse_resolution_(1.0 / resolution), grid_(openvdb::FloatGrid::create(0.0F)) {}

  [[nodiscard]] Cells cells() const override {
    Cells cells;
    for (auto value = grid_->cbeginValueOn(); value; ++value) {
      cells.known += 1.0;
      cells.surface += *value > 0.0F ? 1.0 : 0.0;
    }
    return cells;
  }

 protected:
  [[nodiscard]] openvdb::Vec3d inCells(const Eigen::Vector3d& p) const {
    return {p.x() * inverse_resolution_, p.y() * inverse_resolution_, p.z() * inverse_resolution_};
  }

  double inverse_resolution_;
  openvdb::FloatGrid::Ptr grid_;
};

class OpenVdbRays : public OpenVdbEngine {
 public:
  using OpenVdbEngine::OpenVdbEngine;
  void insert(std::span<const MappedReturn> scan) override {
    const openvdb::MaskGrid::Ptr free = openvdb::MaskGrid::create(), hit = openvdb::MaskGrid::create();
    auto free_cells = free->getAccessor(), hit_cells = hit->getAccessor();
    for (const MappedReturn& ret : scan) {
      const openvdb::Vec3d from = inCells(ret.origin_world), to = inCells(ret.p_world);
      const openvdb::Coord last = openvdb::Coord::floor(to);
      const double length = (to - from).length();
      openvdb::math::DDA<openvdb::math::Ray<double>, 0> walk({from, (to - from) / length}, 0.0, length);
      do {
        if (walk.voxel() == last) break;
        free_cells.setValueOn(walk.voxel());
      } while (walk.step());
      hit_cells.setValueOn(last);
    }
    Accessor accessor = grid_->getAccessor();
    for (auto value = hit->cbeginValueOn(); value; ++value) update(accessor, value.getCoord(), kHit);
    for (auto value = free->cbeginValueOn(); value; ++value) {
      if (!hit_cells.isValueOn(value.getCoord())) update(accessor, value.getCoord(), kMiss);
    }
  }
};

class OpenVdbPoints : public OpenVdbEngine {
 public:
  using OpenVdbEngine::OpenVdbEngine;
  void insert(std::span<const MappedReturn> scan) override {
    Accessor accessor = grid_->getAccessor();
    for (const MappedReturn& ret : scan) update(accessor, openvdb::Coord::floor(inCells(ret.p_world)), kHit);
  }
};

}  // namespace

EnginePointer openvdbRays(double resolution) {
  openvdb::initialize();
  return std::make_unique<OpenVdbRays>(resolution);
}
EnginePointer openvdbPoints(double resolution) {
  openvdb::initialize();
  return std::make_unique<OpenVdbPoints>(resolution);
}

}  // namespace thermovox::bench
