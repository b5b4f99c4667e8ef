#pragma once

#include <array>
#include <variant>

#include "projection/laser/laser_return.hpp"
#include "projection/mission.hpp"

namespace thermovox {

/// A symmetric covariance of a position: xx xy xz yy yz zz, m^2. Single precision is ample for the square of
/// an error, and a reading's returns pass through memory several times.
struct PackedCovariance {
  std::array<float, 6> entries{};

  PackedCovariance() = default;
  template <typename Derived>
  PackedCovariance(const Eigen::MatrixBase<Derived>& covariance) {  // of any symmetric 3 x 3 expression
    const Eigen::Matrix3d m = covariance;
    const auto entry = [&](int row, int column) { return static_cast<float>(m(row, column)); };
    entries = {entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)};
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    const auto& [xx, xy, xz, yy, yz, zz] = entries;
    Eigen::Matrix3d m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
};

/// A laser return where it lies in the world.
struct PlacedReturn {
  Time stamp;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();       ///< metres
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();  ///< the laser's centre at that moment, metres
  double range = 0.0;                                      ///< the laser's own reading, metres
  /// Covariance (world, m^2) of what moves the point against the camera: range noise, range bias, extrinsics.
  PackedCovariance rig_covariance;
  PackedCovariance pose_covariance;  ///< of what moves both together
  [[nodiscard]] Eigen::Matrix3d positionCovariance() const {
    return rig_covariance.matrix() + pose_covariance.matrix();
  }
};

/// p_world = T_world_body(stamp of the return) * T_body_laser * p_laser: the pose at the return's own time,
/// which is also the deskew. NoPose where the trajectory cannot say.
[[nodiscard]] std::variant<PlacedReturn, NoPose> place(const LaserReturn& laser_return, const Laser& laser,
                                                       const Mission& mission);

}  // namespace thermovox
