#pragma once

#define PCL_NO_PRECOMPILE
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <limits>
#include <span>

#include "mapping/surface_cloud.hpp"

// The one header of the map that speaks PCL; only who wants PCL's clouds includes it,
// and has to find PCL and link pcl_common for it: thermovox's own libraries do not bring PCL along.

namespace thermovox {

// PCL's macros make anonymous structs in anonymous unions, which are no standard C++.
#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wgnu-anonymous-struct"
#pragma clang diagnostic ignored "-Wnested-anon-types"
#endif

/// A cell that holds a surface, as a PCL point with the fields of the exported PCD.
struct EIGEN_ALIGN16 PointThermal {
  PCL_ADD_POINT4D;  ///< metres, world
  PCL_ADD_RGB;
  float temperature;        ///< C; NaN where no frame saw the cell
  float temperature_sigma;  ///< C; NaN likewise
  std::uint32_t count;      ///< temperature observations
  double time;              ///< of the last one, Unix seconds; NaN without
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

#ifdef __clang__
#pragma clang diagnostic pop
#endif

/// `color(point)` gives a pcl::RGB.
template <typename Color>
[[nodiscard]] pcl::PointCloud<PointThermal> toPclCloud(std::span<const SurfacePoint> points, Color&& color) {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  pcl::PointCloud<PointThermal> cloud;
  cloud.reserve(points.size());
  for (const SurfacePoint& point : points) {
    PointThermal row{};
    row.getVector3fMap() = point.p_world;
    row.data[3] = 1.0F;
    row.rgba = color(point).rgba;
    row.temperature = point.temperature ? point.temperature->celsius : unknown;
    row.temperature_sigma = point.temperature ? point.temperature->sigma : unknown;
    row.count = point.temperature ? point.temperature->count : 0;
    row.time = point.temperature ? point.temperature->time : static_cast<double>(unknown);
    cloud.push_back(row);
  }
  return cloud;
}

}  // namespace thermovox

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT(thermovox::PointThermal,
  (float, x, x)(float, y, y)(float, z, z)(float, rgb, rgb)(float, temperature, temperature)
  (float, temperature_sigma, temperature_sigma)(std::uint32_t, count, count)(double, time, time))
// clang-format on
