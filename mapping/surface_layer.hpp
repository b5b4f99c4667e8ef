#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mapping/thermal_map.hpp"

namespace thermovox {

/// One cell of a map that has a temperature, as a measurement of the surface in it.
struct SurfaceSample {
  CellKey key;
  Eigen::Vector3d p_world;     ///< mean of the cell's returns, metres
  float celsius;               ///< weighted mean of the observations
  float sigma;                 ///< of that mean, C; the camera's common bias apart
  std::uint32_t observations;  ///< temperatures
  std::uint32_t returns;       ///< of lasers, that p_world is the mean of; 0: it is the cell's centre
  SurfaceCell::View best_view;
  Time first;  ///< of the temperatures
  Time last;
};

/// The temperatures of a map as points that are searched by their distance: what hot spots are found in. For
/// one mission's map; a map of several gives their mean.
class SurfaceLayer {
 public:
  explicit SurfaceLayer(const ThermalMap& map);
  SurfaceLayer(SurfaceLayer&&) noexcept;
  SurfaceLayer& operator=(SurfaceLayer&&) noexcept;
  ~SurfaceLayer();

  [[nodiscard]] double resolution() const { return resolution_; }  ///< edge of a cell, metres
  /// In the map's key order.
  [[nodiscard]] std::span<const SurfaceSample> samples() const { return samples_; }
  [[nodiscard]] const SurfaceSample& operator[](std::uint32_t i) const { return samples_[i]; }
  /// Indices of the samples within `radius` metres of a place, ascending.
  [[nodiscard]] std::vector<std::uint32_t> within(const Eigen::Vector3d& p_world, double radius) const;
  /// Unit normal of the surface at a sample, from its neighbours within two and a half cells; its sign is
  /// arbitrary. Zero where they make no plane. Computed at the first call: not thread-safe.
  [[nodiscard]] const Eigen::Vector3f& normal(std::uint32_t i) const;
  /// Whether b lies on the surface that a sees around itself: nearly in its plane (a cell and a half), with a
  /// normal within 37 degrees. Where a normal is unknown: false.
  [[nodiscard]] bool onSameSurface(std::uint32_t a, std::uint32_t b) const;

 private:
  struct Search;
  struct Normal {
    bool known = false;
    Eigen::Vector3f direction = Eigen::Vector3f::Zero();
  };

  double resolution_;
  std::vector<SurfaceSample> samples_;
  std::unique_ptr<Search> search_;
  mutable std::vector<Normal> normals_;
};

}  // namespace thermovox
