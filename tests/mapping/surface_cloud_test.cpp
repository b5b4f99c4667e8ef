#include "mapping/surface_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace thermovox {
namespace {

MappedReturn returnAt(const Eigen::Vector3d& p_world) {
  return {p_world, Eigen::Vector3d::Zero(), Time{}, std::nullopt};
}

TEST(SurfaceCloud, LiesWithinItsCellsAlsoAsFloats) {
  std::mt19937 rng(1);
  for (const double resolution : {0.05, 0.1, 0.03}) {
    ThermalMap map({.resolution = resolution});
    std::uniform_int_distribution<int> cell(-20000, 20000);
    const auto corner = [&] { return cell(rng) * resolution; };  // returns on the very borders of cells
    std::vector<MappedReturn> reading;
    for (int i = 0; i < 20000; ++i) reading.push_back(returnAt({corner(), corner(), corner()}));
    map.integrate(reading, Carving::none);
    std::vector<CellKey> keys;
    forEachSurface(map, [&](const CellKey& key, const SurfaceCell&) { keys.push_back(key); });
    const std::vector<SurfacePoint> cloud = surfaceCloud(map);
    ASSERT_EQ(cloud.size(), keys.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double x = cloud[i].p_world[axis];
        const std::int32_t k = axis == 0 ? keys[i].x : (axis == 1 ? keys[i].y : keys[i].z);
        ASSERT_EQ(std::floor(x / resolution), k);
        ASSERT_EQ(std::floor(x * (1.0 / resolution)), k);
      }
    }
  }
}

TEST(SurfaceCloud, IsTheMeanOfTheReturnsAndTheirTemperature) {
  ThermalMap map({.resolution = 0.1});
  MappedReturn first = returnAt({1.02, 2.02, 3.02});
  first.temperature = TemperatureObservation{42.0F, 0.2F, 3.0F, 0.1F};
  first.stamp = Time(std::chrono::milliseconds(12500));
  const MappedReturn second = returnAt({1.06, 2.06, 3.06});
  map.integrate(std::vector{first, second}, Carving::none);
  const std::vector<SurfacePoint> cloud = surfaceCloud(map);
  ASSERT_EQ(cloud.size(), 1U);
  EXPECT_LT((cloud[0].p_world - Eigen::Vector3f(1.04F, 2.04F, 3.04F)).norm(), 5e-4);
  ASSERT_TRUE(cloud[0].temperature);
  EXPECT_NEAR(cloud[0].temperature->celsius, 42.0, 1e-4);
  EXPECT_NEAR(cloud[0].temperature->sigma, 0.2, 1e-4);
  EXPECT_EQ(cloud[0].temperature->count, 1U);
  EXPECT_NEAR(cloud[0].temperature->time, 12.5, 33e-6);  // as a cell keeps it
}

TEST(SurfaceCloud, HasNoTemperatureWhereNoFrameSaw) {
  ThermalMap map({});
  map.integrate(std::vector{returnAt({1, 2, 3})}, Carving::octomap);
  EXPECT_FALSE(surfaceCloud(map).at(0).temperature);
}

}  // namespace
}  // namespace thermovox
