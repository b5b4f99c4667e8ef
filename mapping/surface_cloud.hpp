#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/thermal_map.hpp"

namespace thermovox {

/// A surface temperature as it is exported.
struct SurfaceTemperature {
  float celsius;        ///< weighted mean of the observations
  float sigma;          ///< standard deviation of that mean, C; the camera's common bias apart
  std::uint32_t count;  ///< observations
  double time;          ///< of the last one, Unix seconds
};

/// One cell that holds a surface, as other programs take it.
struct SurfacePoint {
  /// Mean of the cell's returns, metres, world. Lies within the cell also as a float: floor(p / resolution)
  /// is the cell's key, whether one divides or multiplies with the inverse (up to 2^23 cells from the origin,
  /// where floats end).
  Eigen::Vector3f p_world;
  std::optional<SurfaceTemperature> temperature;  ///< none where no frame saw the cell
};

[[nodiscard]] SurfacePoint surfacePoint(const ThermalMap& map, const CellKey& key, const SurfaceCell& cell);

/// All cells that hold a surface, in the map's key order.
[[nodiscard]] std::vector<SurfacePoint> surfaceCloud(const ThermalMap& map);

}  // namespace thermovox
