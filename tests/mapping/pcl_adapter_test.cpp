#include "mapping/pcl_adapter.hpp"

#include <gtest/gtest.h>
#include <pcl/common/io.h>

#include <cmath>
#include <vector>

namespace thermovox {
namespace {

TEST(PclAdapter, CarriesEveryFieldOfASurfacePoint) {
  const std::vector<SurfacePoint> points{{{1, 2, 3}, SurfaceTemperature{42.5F, 0.25F, 7, 1.7e9}},
                                         {{4, 5, 6}, {}}};
  const auto cloud = toPclCloud(points, [](const SurfacePoint& point) {
    return point.temperature ? pcl::RGB(255, 128, 0) : pcl::RGB(128, 128, 128);
  });
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud[0].getVector3fMap(), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(cloud[0].r, 255);
  EXPECT_EQ(cloud[0].g, 128);
  EXPECT_EQ(cloud[0].temperature, 42.5F);
  EXPECT_EQ(cloud[0].temperature_sigma, 0.25F);
  EXPECT_EQ(cloud[0].count, 7U);
  EXPECT_EQ(cloud[0].time, 1.7e9);
  EXPECT_TRUE(std::isnan(cloud[1].temperature));
  EXPECT_EQ(cloud[1].count, 0U);
}

TEST(PclAdapter, NamesTheFieldsOfTheExportedFiles) {
  const auto fields = pcl::getFields<PointThermal>();
  std::vector<std::string> names;
  for (const auto& field : fields) names.push_back(field.name);
  EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z", "rgb", "temperature", "temperature_sigma",
                                             "count", "time"}));
}

}  // namespace
}  // namespace thermovox
