#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "apps/simulate/flight.hpp"
#include "apps/simulate/hall.hpp"
#include "apps/simulate/hall_layout.hpp"
#include "apps/simulate/random.hpp"

namespace thermovox::simulate {
namespace {

Hall smallHall() {
  return {{12.0, 8.0, 5.0},
          {{{1.0, 2.0, 0.0}, {3.0, 3.0, 2.5}, 30.0}, {{-4.0, -3.0, 1.0}, {-2.0, -2.0, 1.5}, 26.5}},
          {{0.0, -2.0, 0.25, 3.0, 24.0}},
          {{{2.0, 2.0, 1.5}, 40.0, 0.1, 70.0}, {{0.0, -1.75, 2.0}, 25.0, 0.08, 49.0}}};
}

/// A direction spread evenly over the sphere.
Eigen::Vector3d anyDirection(Random& random) {
  Eigen::Vector3d d = random.normal3();
  while (d.norm() < 1e-6) d = random.normal3();
  return d.normalized();
}

TEST(Hall, NearestSurfaceHasTheValuesOfTheIndependentEvaluation) {
  struct Expected {
    Eigen::Vector3d p;
    double temperature;
    double distance;
  };
  // Computed once by the evaluation program that defines what a truth file means.
  const std::vector<Expected> expected{{{2, 2, 1.5}, 70.0, 0.0},
                                       {{2.05, 1.99, 1.47}, 63.578280831, 0.01},
                                       {{1.2, 2.4, 2.6}, 30.0, 0.1},
                                       {{2.5, 2.6, 1.2}, 30.0, 0.4},
                                       {{-3, -1.9, 1.2}, 26.5, 0.1},
                                       {{0.02, -1.7, 2.04}, 41.589696859, 0.050665928},
                                       {{0.1, -2.1, 3.3}, 24.0, 0.319044389},
                                       {{0.2, -1.9, 1}, 24.0, 0.026393202},
                                       {{5.9, 0, 2}, 21.0, 0.1},
                                       {{0, 3.8, 4}, 21.5, 0.2},
                                       {{0.3, 0.2, 0.1}, 20.0, 0.1},
                                       {{0.3, 0.2, 4.8}, 20.0, 0.2},
                                       {{-3, -2.5, 1.2}, 26.5, 0.2}};
  const Hall hall = smallHall();
  for (const Expected& e : expected) {
    SCOPED_TRACE(testing::Message() << e.p.transpose());
    const NearestSurface nearest = hall.nearestSurface(e.p);
    EXPECT_NEAR(nearest.temperature, e.temperature, 1e-8);
    EXPECT_NEAR(nearest.distance, e.distance, 1e-8);
  }
}

TEST(Hall, RaysMeetWallsBoxesAndCylindersWhereTheyStand) {
  const Hall hall = smallHall();
  const auto wall = hall.castRay({0.0, 0.0, 2.0}, Eigen::Vector3d::UnitX());
  ASSERT_TRUE(wall);
  EXPECT_DOUBLE_EQ(wall->range, 6.0);
  EXPECT_DOUBLE_EQ(wall->temperature, Hall::kEndWallCelsius);
  EXPECT_EQ(wall->normal, -Eigen::Vector3d::UnitX());
  const auto box = hall.castRay({2.0, 0.5, 1.5}, Eigen::Vector3d::UnitY());
  ASSERT_TRUE(box);
  EXPECT_DOUBLE_EQ(box->range, 1.5);
  EXPECT_DOUBLE_EQ(box->temperature, 70.0);
  const auto side = hall.castRay({0.0, 0.0, 1.0}, -Eigen::Vector3d::UnitY());
  ASSERT_TRUE(side);
  EXPECT_DOUBLE_EQ(side->range, 1.75);
  EXPECT_NEAR((side->normal - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
  const auto top = hall.castRay({0.1, -2.0, 4.5}, -Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(top);
  EXPECT_DOUBLE_EQ(top->range, 1.5);
  EXPECT_DOUBLE_EQ(top->temperature, 24.0);
}

TEST(Hall, RaysFromOutsideOrWithoutDirectionMeetNothing) {
  const Hall hall = smallHall();
  EXPECT_FALSE(hall.castRay({7.0, 0.0, 1.0}, Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(hall.castRay({0.0, 0.0, std::nan("")}, Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(hall.castRay({0.0, 0.0, 1.0}, {std::nan(""), 0.0, 1.0}));
}

TEST(Hall, EveryHitLiesOnASurfaceThatHasItsTemperatureAndNothingLiesBefore) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Hall hall = makeHall(seed);
    const Flight flight(hall, FlightStyle::along_aisle, 6.0, seed);
    Random random(seed, RandomStream::laser);
    int on_edges = 0;
    constexpr int kRays = 4000;
    for (int i = 0; i < kRays; ++i) {
      const Eigen::Vector3d origin = flight.at(random.uniform(0.0, 6.0)).translation;
      const Eigen::Vector3d direction = anyDirection(random);
      const auto hit = hall.castRay(origin, direction);
      ASSERT_TRUE(hit);
      const Eigen::Vector3d p = origin + hit->range * direction;
      SCOPED_TRACE(testing::Message() << "seed " << seed << " ray " << i << " to " << p.transpose());
      const NearestSurface nearest = hall.nearestSurface(p);
      ASSERT_LT(nearest.distance, 1e-9);
      ASSERT_LT(hit->normal.dot(direction), 0.0);
      ASSERT_NEAR(hit->normal.norm(), 1.0, 1e-9);
      if (std::abs(nearest.temperature - hit->temperature) > 1e-6) ++on_edges;  // two surfaces touch here
      // The first surface, marched: no point of the ray before the hit is nearer to a surface than it may be.
      const Eigen::Vector3d before = origin + (hit->range - 0.02) * direction;
      ASSERT_GT(hall.nearestSurface(before).distance, 0.0);
      ASSERT_FALSE(hall.occluded(origin, p));
      ASSERT_TRUE(hall.occluded(origin, p + 0.2 * direction));
    }
    EXPECT_LT(on_edges, 5);
  }
}

TEST(Hall, LayoutIsOfTheSeedAndKeepsTheAisleFree) {
  EXPECT_EQ(makeHall(7).size(), makeHall(7).size());
  EXPECT_NE(makeHall(7).size(), makeHall(8).size());
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Hall hall = makeHall(seed);
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    EXPECT_GE(hall.hotSpots().size(), 3U);
    for (const Box& box : hall.boxes()) {
      EXPECT_TRUE((box.low.array() < box.high.array()).all());
      EXPECT_GT(std::min(std::abs(box.low.y()), std::abs(box.high.y())), kAisleHalfWidth);
      EXPECT_LT(std::max(std::abs(box.low.y()), std::abs(box.high.y())), hall.size().y() / 2);
      EXPECT_LT(box.high.z(), hall.size().z());
    }
    for (const Cylinder& cylinder : hall.cylinders()) {
      EXPECT_GT(std::abs(cylinder.y) - cylinder.radius, kAisleHalfWidth);
      EXPECT_GE(cylinder.top, kLowestTop);
      EXPECT_LT(cylinder.top, hall.size().z());
    }
    for (const HotSpot& spot : hall.hotSpots()) {
      EXPECT_LT(hall.nearestSurface(spot.position).distance, 1e-9);
      EXPECT_NEAR(hall.temperatureAt(spot.position), spot.peak, 0.01);
    }
  }
}

TEST(Flight, StaysInTheAisleAndTurnsSmoothly) {
  for (const FlightStyle style : {FlightStyle::facing_rows, FlightStyle::along_aisle}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Hall hall = makeHall(seed);
      const Flight flight(hall, style, 6.0, seed);
      const auto poses = flight.sample(-0.05, 20.0, 100.0);
      for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
        const Pose& pose = poses[i].T_world_body;
        ASSERT_LT(std::abs(pose.translation.y()), 0.6);
        ASSERT_LT(pose.translation.z(), kLowestTop - 0.3);
        // A reader interpolates between poses; the path must not bend more than that can follow.
        const Pose middle = interpolate(poses[i - 1].T_world_body, poses[i + 1].T_world_body, 0.5);
        ASSERT_LT(middle.rotation.angularDistance(pose.rotation), 4e-3);
        ASSERT_LT((middle.translation - pose.translation).norm(), 4e-3);
      }
    }
  }
}

}  // namespace
}  // namespace thermovox::simulate
