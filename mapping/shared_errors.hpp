#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "mapping/cell_key.hpp"
#include "projection/mission.hpp"
#include "projection/placement.hpp"

namespace thermovox {

/// How the errors that all measurements of a mission share move the returns of one laser in one cube of the
/// world: the means of the derivatives over those returns, each as if it lay in the cube's centre, so that
/// what holds at any other place follows (a metre at four metres is a quarter of a radian of the view). They
/// are linear in the errors, so the mean of the returns moves by the mean of the derivatives; returns that
/// were seen from all sides move less than each.
struct SharedMotion {
  /// Edge of a cube, metres: within it the derivatives hardly change.
  static constexpr double kEdge = 1.0;

  BlockKey cube;            ///< cube k covers [k, k + 1) * kEdge on each axis of the world
  std::uint32_t laser = 0;  ///< of the rig
  std::uint32_t count = 0;  ///< returns that the means are of
  Eigen::Matrix3f by_rotation = Eigen::Matrix3f::Zero();     ///< of T_body_laser: -R_world_body [R p_laser]x
  Eigen::Matrix3f by_translation = Eigen::Matrix3f::Zero();  ///< of T_body_laser: R_world_body
  Eigen::Vector3f by_range = Eigen::Vector3f::Zero();        ///< the ray's direction
  Eigen::Vector3f lever = Eigen::Vector3f::Zero();  ///< from the body to the cube's centre, world, metres
  /// From the camera, where it could see the return, to the cube's centre, world, metres; zero: it saw none.
  Eigen::Vector3f view = Eigen::Vector3f::Zero();

  [[nodiscard]] Eigen::Vector3d centre() const {
    return (Eigen::Vector3d(cube.x, cube.y, cube.z).array() + 0.5) * kEdge;
  }
};

/// Gathers them while a mission is mapped.
class SharedMotions {
 public:
  /// The mission must outlive the object.
  explicit SharedMotions(const Mission& mission) : mission_(mission) {}

  /// Takes every 32nd return of a reading, and of short ones each.
  void add(std::span<const PlacedReturn> reading, std::size_t laser);
  /// By cube, then laser.
  [[nodiscard]] std::vector<SharedMotion> means() const;

 private:
  struct Sums {
    std::uint32_t count = 0, in_view = 0;
    Eigen::Matrix3d by_rotation = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d by_translation = Eigen::Matrix3d::Zero();
    Eigen::Vector3d by_range = Eigen::Vector3d::Zero();
    Eigen::Vector3d lever = Eigen::Vector3d::Zero();
    Eigen::Vector3d view = Eigen::Vector3d::Zero();
  };
  const Mission& mission_;
  std::map<std::tuple<BlockKey, std::uint32_t>, Sums> sums_;
};

/// The same after a rigid motion of the world: T_world_map takes the old coordinates to the new ones. A cube
/// goes where its centre goes; those that meet are averaged. Throws DataError where one leaves the world.
[[nodiscard]] std::vector<SharedMotion> moved(std::span<const SharedMotion> motions, const Pose& T_world_map);

/// What a mission declares of its errors besides its rig's.
struct PoseSigmas {
  double rotation = 0.0;     ///< one sigma an axis, radians
  double translation = 0.0;  ///< one sigma an axis, metres
};

/// Covariance (world, m^2) of a hot spot at p_world that the shared errors cause. `motions` as means() gives
/// them; the nearest cube within two metres speaks for places that no return was counted for; where there is
/// none only the poses' translation is left.
///
/// An error of the pose moves laser and camera together, and the spot with them. One of the laser alone moves
/// the surface by e, but not the camera's ray along which the spot was seen: the spot stays where this ray
/// meets the moved surface, X + d (n e) / (n d), with the ray's direction d and the surface's normal n (zero:
/// unknown, then it moves by e).
[[nodiscard]] Eigen::Matrix3d sharedCovariance(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal,
                                               std::span<const SharedMotion> motions, const Rig& rig,
                                               const PoseSigmas& pose);

}  // namespace thermovox
