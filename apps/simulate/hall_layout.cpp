#include "apps/simulate/hall_layout.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "apps/simulate/random.hpp"

namespace thermovox::simulate {
namespace {

/// The piece of a row that one cabinet or tower stands in; `side` is -1 or +1, towards the wall.
struct Bay {
  double x_low = 0.0;
  double x_high = 0.0;
  double side = 1.0;
  double front = 0.0;  ///< |y| of the face to the aisle
  double back = 0.0;   ///< |y| of the face to the wall
};

/// Joints above are not to be hot: a laser that turns level in the aisle would hardly see them, metres.
constexpr double kHighestJoint = 3.1;

struct Layout {
  std::vector<Box> boxes;
  std::vector<Cylinder> cylinders;
  std::vector<HotSpot> joints;  ///< places where a joint may run hot; delta, sigma and peak come later
};

Box makeBox(const Bay& bay, double bottom, double top, double celsius) {
  const double y0 = bay.side * bay.front;
  const double y1 = bay.side * bay.back;
  return {{bay.x_low, std::min(y0, y1), bottom}, {bay.x_high, std::max(y0, y1), top}, celsius};
}

/// A place on the face to the aisle, `margin` metres or more from its edges.
HotSpot jointOnFace(const Box& box, double side, double margin, Random& random) {
  const double x = random.uniform(box.low.x() + margin, box.high.x() - margin);
  const double low = std::max(box.low.z() + margin, 0.9);
  const double z = random.uniform(low, std::min(box.high.z() - margin, low + 1.7));
  return {{x, side > 0.0 ? box.low.y() : box.high.y(), z}, 0.0, 0.0, box.celsius};
}

/// A place on the side of a cylinder that looks at the aisle.
HotSpot jointOnCylinder(const Cylinder& cylinder, double side, double height, Random& random) {
  const double angle = random.uniform(-0.5, 0.5);  // radians off the direction to the aisle
  const double x = cylinder.x + cylinder.radius * std::sin(angle);
  const double y = cylinder.y - side * cylinder.radius * std::cos(angle);
  return {{x, y, height}, 0.0, 0.0, cylinder.celsius};
}

void addCabinet(const Bay& bay, Layout& layout, Random& random) {
  const Box cabinet = makeBox(bay, 0.0, random.uniform(kLowestTop, 3.3), random.uniform(23.5, 31.5));
  layout.joints.push_back(jointOnFace(cabinet, bay.side, 0.3, random));
  layout.boxes.push_back(cabinet);
  const int bushings = random.index(3);
  const double height = random.uniform(0.6, 1.1);
  const double radius = random.uniform(0.09, 0.16);
  for (int i = 0; i < bushings; ++i) {
    const double x = bay.x_low + (bay.x_high - bay.x_low) * (i + 1.0) / (bushings + 1.0);
    const double y = bay.side * (bay.front + 0.35);
    layout.cylinders.push_back({x, y, radius, cabinet.high.z() + height, random.uniform(22.0, 25.0)});
    const double flange = cabinet.high.z() + 0.2;
    if (flange < kHighestJoint) {
      layout.joints.push_back(jointOnCylinder(layout.cylinders.back(), bay.side, flange, random));
    }
  }
}

/// Modules one above the other between four posts that carry them.
void addTower(const Bay& bay, Layout& layout, Random& random) {
  constexpr int kModules = 3;
  const double pitch = random.uniform(1.05, 1.25);
  const double thickness = random.uniform(0.5, 0.65);
  const double bottom = random.uniform(0.45, 0.7);
  const double celsius = random.uniform(25.0, 31.0);
  for (int i = 0; i < kModules; ++i) {
    const double low = bottom + i * pitch;
    layout.boxes.push_back(makeBox(bay, low, low + thickness, celsius + random.uniform(-1.0, 1.0)));
    if (i > 0) layout.joints.push_back(jointOnFace(layout.boxes.back(), bay.side, 0.15, random));
  }
  const double top = bottom + (kModules - 1) * pitch + thickness + 0.15;
  for (const double x : {bay.x_low + 0.15, bay.x_high - 0.15}) {
    for (const double y : {bay.front + 0.15, bay.back - 0.15}) {
      layout.cylinders.push_back({x, bay.side * y, 0.06, top, celsius - 2.0});
    }
  }
}

void addRow(double side, const Eigen::Vector3d& size, Layout& layout, Random& random) {
  const int bays = 4 + random.index(2);
  const double first = -size.x() / 2 + 1.2;
  const double pitch = (size.x() - 2.4) / bays;
  for (int i = 0; i < bays; ++i) {
    const double center = first + (i + 0.5) * pitch + random.uniform(-0.25, 0.25);
    const double half = random.uniform(0.27, 0.36) * pitch;
    const double front = random.uniform(2.2, 2.7);
    const Bay bay{center - half, center + half, side, front, front + random.uniform(0.9, 1.3)};
    if (random.uniform() < 0.25) {
      addTower(bay, layout, random);
    } else {
      addCabinet(bay, layout, random);
    }
    if (i > 0 && random.uniform() < 0.4) {
      const double x = first + i * pitch + random.uniform(-0.2, 0.2);
      const double y = side * random.uniform(kAisleHalfWidth + 0.3, 2.0);
      const double top = random.uniform(kLowestTop, 3.4);
      layout.cylinders.push_back({x, y, random.uniform(0.1, 0.18), top, random.uniform(22.5, 27.0)});
      layout.joints.push_back(
          jointOnCylinder(layout.cylinders.back(), side, random.uniform(1.3, 2.3), random));
    }
  }
}

/// A duct for the bus bars over each row, from end to end of the hall.
void addDucts(const Eigen::Vector3d& size, Layout& layout, Random& random) {
  for (const double side : {-1.0, 1.0}) {
    const double front = random.uniform(3.7, 4.0);
    const double bottom = size.z() - random.uniform(0.9, 1.2);
    const Bay bay{-size.x() / 2 + 0.4, size.x() / 2 - 0.4, side, front, front + 0.4};
    layout.boxes.push_back(makeBox(bay, bottom, bottom + 0.35, random.uniform(21.0, 22.5)));
  }
}

/// Picks joints that run hot, no two of them closer than a metre.
std::vector<HotSpot> heatJoints(std::vector<HotSpot> joints, Random& random) {
  const std::size_t wanted = 5 + static_cast<std::size_t>(random.index(3));
  std::vector<HotSpot> hot;
  while (!joints.empty() && hot.size() < wanted) {
    const auto picked = std::next(joints.begin(), random.index(static_cast<int>(joints.size())));
    HotSpot spot = *picked;
    joints.erase(picked);
    const bool crowded = std::any_of(hot.begin(), hot.end(), [&spot](const HotSpot& other) {
      return (other.position - spot.position).norm() < 1.0;
    });
    if (crowded) continue;
    spot.delta = random.uniform(22.0, 62.0);
    spot.sigma = random.uniform(0.065, 0.125);
    spot.peak += spot.delta;
    hot.push_back(spot);
  }
  return hot;
}

}  // namespace

Hall makeHall(std::uint64_t seed) {
  Random random(seed, RandomStream::hall);
  const double length = random.uniform(17.0, 20.0);
  const double width = random.uniform(9.4, 10.6);
  const double height = random.uniform(5.6, 6.4);
  const Eigen::Vector3d size(length, width, height);
  Layout layout;
  for (const double side : {-1.0, 1.0}) addRow(side, size, layout, random);
  addDucts(size, layout, random);
  std::vector<HotSpot> hot_spots = heatJoints(std::move(layout.joints), random);
  return {size, std::move(layout.boxes), std::move(layout.cylinders), std::move(hot_spots)};
}

}  // namespace thermovox::simulate
