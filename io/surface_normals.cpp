#include "io/surface_normals.hpp"

#include <Eigen/Eigenvalues>
#include <cstddef>
#include <unordered_map>

#include "mapping/cell_key.hpp"

namespace thermovox {
namespace {

/// Points by the cell of `radius` edge that they lie in: neighbours are in the 27 cells around.
using Grid = std::unordered_map<BlockKey, std::vector<std::size_t>, BlockKeyHash>;

BlockKey cellOf(const Eigen::Vector3f& p, double inverse_radius) {
  const CellKey key = cellKey(p.cast<double>(), inverse_radius);
  return {key.x, key.y, key.z};
}

/// First and second moments about a point.
struct Moments {
  int count = 0;
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Matrix3f second = Eigen::Matrix3f::Zero();
};

template <typename Visit>
void forEachAround(const Grid& grid, const BlockKey& center, Visit&& visit) {
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const auto cell = grid.find({center.x + dx, center.y + dy, center.z + dz});
        if (cell == grid.end()) continue;
        for (const std::size_t i : cell->second) visit(i);
      }
    }
  }
}

}  // namespace

std::vector<LocalSurface> localSurfaces(std::span<const Eigen::Vector3f> points, double radius) {
  constexpr int kFewest = 5;
  Grid grid;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) grid[cellOf(points[i], 1.0 / radius)].push_back(i);
  }
  const auto limit = static_cast<float>(radius * radius);
  std::vector<LocalSurface> surfaces(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;
    Moments moments;
    forEachAround(grid, cellOf(points[i], 1.0 / radius), [&](std::size_t neighbour) {
      const Eigen::Vector3f d = points[neighbour] - points[i];
      if (d.squaredNorm() > limit) return;
      ++moments.count;
      moments.first += d;
      moments.second += d * d.transpose();
    });
    surfaces[i].neighbours = moments.count;
    if (moments.count < kFewest) continue;
    const auto n = static_cast<float>(moments.count);
    const Eigen::Matrix3f spread = moments.second / n - moments.first * moments.first.transpose() / (n * n);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(spread);
    surfaces[i].normal = solver.eigenvectors().col(0);
  }
  return surfaces;
}

}  // namespace thermovox
