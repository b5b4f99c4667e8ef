#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace thermovox::bench {

/// A box with faces along the axes, metres, and its temperature.
struct Box {
  Eigen::Vector3d low, high;
  float celsius = 20.0F;
};

/// An upright cylinder from the floor, metres, and its temperature.
struct Cylinder {
  Eigen::Vector2d centre;
  double radius = 0.0, top = 0.0;
  float celsius = 20.0F;
};

/// A warehouse of 60 x 30 x 12 m, its floor at z = 0 and x, y about 0: four rows of racks, whose shelves and
/// goods are 627 boxes, and 16 cylinders.
class HallScene {
 public:
  static constexpr std::size_t kBoxes = 627, kCylinders = 16;
  static inline const Eigen::Vector3d kSize{60.0, 30.0, 12.0};  ///< metres
  /// Rows of racks run along x at these y, metres.
  static constexpr std::array kRackRows = {-10.5, -3.5, 3.5, 10.5};

  /// Same seed, same goods.
  explicit HallScene(std::uint64_t seed);

  /// What a ray meets first.
  struct Hit {
    double range = 0.0;  ///< metres
    Eigen::Vector3d normal{0.0, 0.0, 0.0};
    float celsius = 20.0F;
  };
  /// Precondition: `origin` (metres) lies within the hall, `direction` has length 1.
  [[nodiscard]] Hit cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  [[nodiscard]] const std::vector<Box>& boxes() const { return boxes_; }
  [[nodiscard]] const std::vector<Cylinder>& cylinders() const { return cylinders_; }

 private:
  static constexpr int kNx = 60, kNy = 30, kNz = 12;  // bins of one metre
  void addRacks(std::uint64_t seed);
  void addCylinders();
  void fillBins();
  void bin(const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::uint16_t object);

  std::vector<Box> boxes_;
  std::vector<Cylinder> cylinders_;
  /// Objects that reach into a bin: a box's index, or kBoxes plus a cylinder's.
  std::vector<std::vector<std::uint16_t>> bins_;
};

}  // namespace thermovox::bench
