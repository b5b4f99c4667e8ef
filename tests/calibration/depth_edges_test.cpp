#include "calibration/depth_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace thermovox {
namespace {

using Range = std::function<double(double azimuth, double elevation)>;

Laser laserOf(LaserKind kind) {
  Laser laser;
  laser.kind = kind;
  laser.angle_min = -0.5;
  laser.angle_increment = 0.01;
  return laser;
}

Time at(double seconds) {
  return Time(durationFromSeconds(seconds));
}

LaserReturn echo(double seconds, double azimuth, double elevation, double range) {
  return {at(seconds), range * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation))};
}

/// 101 angles from -0.5 to 0.5.
Reading scan(double seconds, const Range& range) {
  Reading reading{.stamp = at(seconds)};
  for (int i = 0; i <= 100; ++i)
    reading.returns.push_back(echo(seconds, -0.5 + 0.01 * i, 0.0, range(-0.5 + 0.01 * i, 0.0)));
  return reading;
}

double azimuthOf(const Eigen::Vector3d& p) {
  return std::atan2(p.y(), p.x());
}

/// Something at 3 m from azimuth -0.1 to 0.2, elevation -0.1 to 0.1, before a wall at 8 m.
double boxBeforeWall(double azimuth, double elevation) {
  return azimuth > -0.105 && azimuth < 0.205 && std::abs(elevation) < 0.105 ? 3.0 : 8.0;
}

TEST(DepthEdges, OfAScanLieBetweenItsNeighbours) {
  const auto edges = edgesWithin(scan(0.0, boxBeforeWall), laserOf(LaserKind::scan));
  ASSERT_EQ(edges.size(), 2U);
  EXPECT_NEAR(azimuthOf(edges[0].near_laser), -0.10, 1e-9);
  EXPECT_NEAR(azimuthOf(edges[0].past_laser), -0.11, 1e-9);
  EXPECT_NEAR(azimuthOf(edges[1].near_laser), 0.20, 1e-9);
  EXPECT_NEAR(azimuthOf(edges[1].past_laser), 0.21, 1e-9);
  for (const DepthEdge& edge : edges) {
    EXPECT_NEAR(edge.near_laser.norm(), 3.0, 1e-9);
    EXPECT_NEAR(edge.past_laser.norm(), 3.0, 1e-9) << "as far out as the nearer surface";
  }
}

TEST(DepthEdges, ASlantedWallHasNone) {
  const auto wall = [](double azimuth, double) { return 1.0 / std::max(0.02, std::sin(0.52 - azimuth)); };
  EXPECT_TRUE(edgesWithin(scan(0.0, wall), laserOf(LaserKind::scan)).empty());
}

TEST(DepthEdges, ALoneReturnBeforeAWallIsNoSurface) {
  const auto speck = [](double azimuth, double) { return std::abs(azimuth) < 0.005 ? 3.0 : 8.0; };
  EXPECT_TRUE(edgesWithin(scan(0.0, speck), laserOf(LaserKind::scan)).empty());
}

TEST(DepthEdges, OfACloudAreFoundOnAllSides) {
  Reading cloud;
  for (int column = -30; column <= 30; ++column) {
    for (int row = -10; row <= 10; ++row)
      cloud.returns.push_back(echo(0.0, 0.02 * column, 0.02 * row, boxBeforeWall(0.02 * column, 0.02 * row)));
  }
  int left = 0, right = 0, above = 0, below = 0;
  for (const DepthEdge& edge : edgesWithin(cloud, laserOf(LaserKind::cloud))) {
    EXPECT_NEAR(edge.near_laser.norm(), 3.0, 1e-9);
    const Eigen::Vector3d way = edge.past_laser - edge.near_laser;
    if (std::abs(way.y()) > std::abs(way.z())) {
      ++(way.y() > 0.0 ? left : right);
    } else {
      ++(way.z() > 0.0 ? above : below);
    }
  }
  // The box shows 16 columns and 11 rows.
  EXPECT_EQ(left, 11);
  EXPECT_EQ(right, 11);
  EXPECT_EQ(above, 16);
  EXPECT_EQ(below, 16);
}

TEST(DepthEdges, BetweenScansAreWhereTheLaterOneComesUponSomething) {
  const Laser laser = laserOf(LaserKind::scan);
  const Reading wall = scan(1.0, [](double, double) { return 8.0; }), box = scan(1.025, boxBeforeWall);
  const auto edges = edgesBetween(wall, box, laser);
  EXPECT_EQ(edges.size(), 31U) << "all returns of the box";
  for (const DepthEdge& edge : edges) {
    EXPECT_EQ(edge.near_stamp, at(1.025));
    EXPECT_EQ(edge.past_stamp, at(1.0));
    EXPECT_NEAR(edge.near_laser.norm(), 3.0, 1e-9);
  }
  EXPECT_TRUE(edgesBetween(box, box, laser).empty());
}

TEST(DepthEdges, OfABeamLieAlongItsTrack) {
  std::vector<LaserReturn> track;
  for (int i = 0; i < 20; ++i) track.push_back(echo(0.01 * i, 0.0, 0.0, i < 12 ? 3.0 : 8.0));
  ASSERT_EQ(edgesAlong(track).size(), 1U);
  EXPECT_EQ(edgesAlong(track).front().near_stamp, at(0.11));
  EXPECT_EQ(edgesAlong(track).front().past_stamp, at(0.12));
  for (std::size_t i = 12; i < track.size(); ++i) track[i].stamp += std::chrono::seconds(1);
  EXPECT_TRUE(edgesAlong(track).empty()) << "a pause says nothing";
  EXPECT_TRUE(edgesAlong({}).empty());
}

}  // namespace
}  // namespace thermovox
