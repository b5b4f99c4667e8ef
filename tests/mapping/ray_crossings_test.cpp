#include "mapping/ray_crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace thermovox {
namespace {

constexpr CpuLevel kLevels[] = {CpuLevel::baseline, CpuLevel::avx2, CpuLevel::avx512};

/// The cells of a ray before its last one, by its crossings.
std::set<CellKey> cellsByCrossings(const RayCells& ray, CpuLevel level) {
  std::set<CellKey> cells;
  if (ray.first() == ray.last()) return cells;
  const TileKey first_tile = tileOf(blockOf(ray.first()));
  RayCrossings::Codes codes;
  cells.insert(ray.first());
  RayCrossings(ray, level).forEachChunk(codes, [&](const RayCrossings::Codes& chunk, int count) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const TileKey tile = tileOfCode(chunk.tile[i], first_tile);
      cells.insert(cellAt(blockAt(tile, static_cast<int>(chunk.cell[i] / kBlockCells)),
                          static_cast<int>(chunk.cell[i] % kBlockCells)));
    }
  });
  cells.erase(ray.last());
  return cells;
}

std::set<CellKey> cellsByWalk(const RayCells& ray) {
  std::set<CellKey> cells;
  ray.forEach([&cells](const CellKey& key) { cells.insert(key); });
  return cells;
}

void expectTheWalk(const Eigen::Vector3d& origin, const Eigen::Vector3d& end, double resolution) {
  const RayCells ray(origin, end, resolution);
  for (const CpuLevel level : kLevels) {
    if (level > cpuLevel()) continue;
    EXPECT_EQ(cellsByCrossings(ray, level), cellsByWalk(ray))
        << "from " << origin.transpose() << " to " << end.transpose() << " at " << nameOf(level);
  }
}

TEST(RayCrossings, AreTheCellsOfTheWalkForRandomRays) {
  std::mt19937 rng(3);
  for (const double extent : {0.3, 3.0, 30.0, 300.0}) {
    std::uniform_real_distribution<double> coordinate(-extent, extent);
    const auto point = [&] { return Eigen::Vector3d(coordinate(rng), coordinate(rng), coordinate(rng)); };
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d origin = point(), end = point();
      expectTheWalk(origin, end, 0.05);
    }
  }
}

TEST(RayCrossings, AreTheCellsOfTheWalkAlongTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double way : {-7.3, 0.02, 7.3}) {
      const Eigen::Vector3d origin(0.71, -0.33, 0.05);
      expectTheWalk(origin, origin + way * Eigen::Vector3d::Unit(axis), 0.1);
    }
  }
}

TEST(RayCrossings, TakeEdgesInTheOrderOfTheWalk) {
  // Through the very edges of cells: ties, which the walk takes z first, then y, then x.
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        const Eigen::Vector3d origin = Eigen::Vector3d::Constant(0.125);
        expectTheWalk(origin, origin + 8.0 * Eigen::Vector3d(x, y, z), 0.25);
      }
    }
  }
}

TEST(RayCrossings, StayBesideTheWalkWhereARayIsAllButParallelToAnAxis) {
  // Along a border of cells, off it by less than doubles can tell from the border's own rounding.
  for (const double resolution : {0.01, 0.02, 0.04, 0.05, 0.1}) {
    for (const double aside :
         {1e-15, 1.2e-16, 1e-17, 1e-20, 1e-30, -1e-15, -1.2e-16, -1e-17, -1e-20, -1e-30}) {
      for (const double way : {-10.0, 10.0}) {
        for (const double from : {0.0, -aside}) {
          const RayCells ray({0.0, from, 0.0}, {way, aside, 0.0}, resolution);
          for (const CpuLevel level : kLevels) {
            if (level > cpuLevel()) continue;
            for (const CellKey& cell : cellsByCrossings(ray, level)) {
              ASSERT_LE(std::abs(cell.y), 1) << resolution << " m, " << aside << " m aside";
              ASSERT_EQ(cell.z, 0);
              ASSERT_LE(std::abs(cell.x), 1 + static_cast<int>(10.0 / resolution));
            }
          }
        }
      }
    }
  }
}

TEST(RayCrossings, ReachAsFarAsTheySay) {
  // From the last cell of a tile, so that the last tile is as many away as a code can tell.
  for (const double way : {-1.0, 1.0}) {
    const double resolution = 1.0, reach = RayCrossings::kLongest;
    const Eigen::Vector3d origin(way > 0 ? 63.5 : 0.5, 0.25, 0.25);
    expectTheWalk(origin, origin + way * reach * Eigen::Vector3d::UnitX(), resolution);
  }
}

TEST(RayCrossings, KnowWhenARayIsTooLong) {
  EXPECT_FALSE(RayCrossings(RayCells({0, 0, 0}, {3000, 0, 0}, 0.1)).isTooLong());
  EXPECT_TRUE(RayCrossings(RayCells({0, 0, 0}, {3300, 0, 0}, 0.1)).isTooLong());
}

}  // namespace
}  // namespace thermovox
