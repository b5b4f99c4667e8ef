#include "mapping/imported_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "projection/error.hpp"

namespace thermovox {
namespace {

TEST(ImportedGeometry, HitsEveryCellOnceAndFreesNothing) {
  ThermalMap map({.resolution = 0.1, .occupancy = {}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  addGeometry(
      std::vector<Eigen::Vector3d>{{1.02, 0.05, 0.05}, {1.06, 0.05, 0.05}, {3.0, nan, 0.0}, {-2.05, 0, 0}},
      map);
  EXPECT_EQ(map.surfaceCount(), 2U);
  EXPECT_EQ(map.surface({10, 0, 0})->returns, 2U);
  EXPECT_NEAR(map.surface({10, 0, 0})->meanOffset().x(), 0.4, 0.01);
  EXPECT_EQ(map.surface({10, 0, 0})->observations, 0U);
  EXPECT_NEAR(*map.logOdds({10, 0, 0}), std::log(0.7 / 0.3), 1e-9);
  EXPECT_EQ(map.occupancy({5, 0, 0}), Occupancy::unknown);
}

TEST(ImportedGeometry, OfNoPointIsRefused) {
  ThermalMap map({.resolution = 0.1, .occupancy = {}});
  EXPECT_THROW(addGeometry({}, map), DataError);
  EXPECT_THROW(addGeometry(std::vector<Eigen::Vector3d>{{std::nan(""), 0, 0}}, map), DataError);
  EXPECT_THROW(addGeometry(std::vector<Eigen::Vector3d>{{1e9, 0, 0}}, map), DataError);
}

}  // namespace
}  // namespace thermovox
