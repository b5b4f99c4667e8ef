#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace thermovox::simulate {

/// A box with faces along the world's axes; metres and Celsius.
struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  double celsius = 0.0;
};

/// An upright cylinder from the floor to `top`; metres and Celsius.
struct Cylinder {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
  double top = 0.0;
  double celsius = 0.0;
};

/// A hot joint: adds delta * exp(-r^2 / (2 sigma^2)) to whatever surface is at distance r of it.
struct HotSpot {
  Eigen::Vector3d position;  ///< on a surface, world, metres
  double delta = 0.0;        ///< C above the surface at its centre
  double sigma = 0.0;        ///< metres
  double peak = 0.0;         ///< temperature at its centre, C
};

/// What has become of a hall since it was built.
struct HallChanges {
  double warmer = 0.0;  ///< C, of every surface: a season
  std::map<std::size_t, double>
      joint_rises;         ///< C over the surface, by the spot's place in hotSpots(); 0: repaired
  std::vector<Box> boxes;  ///< that stand there besides, before a joint perhaps
};

/// Where a ray meets the first surface.
struct Hit {
  double range = 0.0;        ///< metres from the ray's origin
  double temperature = 0.0;  ///< of the surface there, C
  Eigen::Vector3d normal;    ///< of the surface, unit, towards the side that the ray came from
};

/// The temperature of the surface nearest to a point.
struct NearestSurface {
  double temperature = 0.0;  ///< C
  double distance = 0.0;     ///< metres
};

/// The true scene: a hall [-L/2, L/2] x [-W/2, W/2] x [0, H] in the world frame with boxes, cylinders and hot
/// spots. Immutable; all questions may be asked from several threads.
class Hall {
 public:
  static constexpr double kFloorCelsius = 20.0;     ///< and of the ceiling, when it was built
  static constexpr double kEndWallCelsius = 21.0;   ///< walls at x = +-L/2
  static constexpr double kSideWallCelsius = 21.5;  ///< walls at y = +-W/2

  /// Size [L, W, H] in metres; its floor, ceiling and walls are `warmer` by so many C than they were built.
  Hall(const Eigen::Vector3d& size, std::vector<Box> boxes, std::vector<Cylinder> cylinders,
       std::vector<HotSpot> hot_spots, double warmer = 0.0);

  /// The same hall later. Throws ConfigError when a joint is none of its hot spots.
  [[nodiscard]] Hall changed(const HallChanges& changes) const;

  [[nodiscard]] const Eigen::Vector3d& size() const { return size_; }
  [[nodiscard]] const std::vector<Box>& boxes() const { return boxes_; }
  [[nodiscard]] const std::vector<Cylinder>& cylinders() const { return cylinders_; }
  [[nodiscard]] const std::vector<HotSpot>& hotSpots() const { return hot_spots_; }
  [[nodiscard]] double warmer() const { return warmer_; }

  /// The first surface along a ray from within the hall; `direction` is a unit vector. nullopt when the
  /// origin is outside the hall or a number is not finite.
  [[nodiscard]] std::optional<Hit> castRay(const Eigen::Vector3d& origin,
                                           const Eigen::Vector3d& direction) const;

  /// Temperature of the surface nearest to p (world), hot spots included, C.
  [[nodiscard]] double temperatureAt(const Eigen::Vector3d& p) const { return nearestSurface(p).temperature; }
  [[nodiscard]] NearestSurface nearestSurface(const Eigen::Vector3d& p) const;

  /// Whether a surface lies between two points, more than `margin` metres before the second: a measured point
  /// stands off its surface by the noise of the range.
  [[nodiscard]] bool occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                              double margin = 0.05) const;

 private:
  [[nodiscard]] double hotSpotExcess(const Eigen::Vector3d& p) const;

  Eigen::Vector3d size_;
  std::vector<Box> boxes_;
  std::vector<Cylinder> cylinders_;
  std::vector<HotSpot> hot_spots_;
  double warmer_ = 0.0;
};

}  // namespace thermovox::simulate
