#include "io/cloud_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "mapping/pcl_adapter.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using testing::HasSubstr;

const std::vector<SurfacePoint> kPoints{
    {{1.5F, -2.25F, 3.125F}, SurfaceTemperature{20.5F, 0.25F, 7, 1700000000.25}},
    {{4.0F, 5.0F, 6.0F}, std::nullopt},
    {{7.0F, 8.0F, 9.0F}, SurfaceTemperature{90.0F, 0.5F, 1, 1700000001.5}}};

std::string onDisk(const std::filesystem::path& path, const std::vector<SurfacePoint>& points = kPoints,
                   const ColourScale& scale = {}) {
  writeCloud(path, points, scale, Existing::replace);
  return test::bytesOf(path);
}

TEST(CloudWriter, WritesPcdThatPclReadsInFull) {
  const test::TestFolder folder;
  onDisk(folder / "map.pcd");
  pcl::PointCloud<PointThermal> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "map.pcd").string(), cloud), 0);
  ASSERT_EQ(cloud.size(), 3U);
  EXPECT_EQ(cloud[0].getVector3fMap(), kPoints[0].p_world);
  EXPECT_EQ(cloud[0].temperature, 20.5F);
  EXPECT_EQ(cloud[0].temperature_sigma, 0.25F);
  EXPECT_EQ(cloud[0].count, 7U);
  EXPECT_EQ(cloud[0].time, 1700000000.25);
  EXPECT_TRUE(std::isnan(cloud[1].temperature));
  EXPECT_TRUE(std::isnan(cloud[1].time));
  EXPECT_EQ(cloud[1].count, 0U);
  EXPECT_EQ(cloud[1].r, 128);
  EXPECT_EQ(cloud[1].g, 128);
  const Rgb hot = colourOf(90.0, spanOf(kPoints, {}), Palette::inferno);
  EXPECT_EQ(cloud[2].r, hot.r);
  EXPECT_EQ(cloud[2].b, hot.b);
}

TEST(CloudWriter, WritesPlyThatPclReads) {
  const test::TestFolder folder;
  const std::string bytes = onDisk(folder / "map.ply");
  pcl::PLYReader reader;
  pcl::PCLPointCloud2 cloud;
  ASSERT_EQ(reader.read((folder / "map.ply").string(), cloud), 0);
  EXPECT_EQ(cloud.width * cloud.height, 3U);
  std::vector<std::string> names;
  for (const auto& field : cloud.fields) names.push_back(field.name);
  EXPECT_THAT(names, testing::ElementsAre("x", "y", "z", "rgb", "scalar_temperature",
                                          "scalar_temperature_sigma", "scalar_count", "scalar_time"));
  float celsius = 0.0F;
  double time = 0.0;
  std::memcpy(&celsius, cloud.data.data() + 2 * cloud.point_step + cloud.fields[4].offset, sizeof celsius);
  std::memcpy(&time, cloud.data.data() + 2 * cloud.point_step + cloud.fields[7].offset, sizeof time);
  EXPECT_EQ(celsius, 90.0F);
  EXPECT_EQ(time, 1700000001.5);
  EXPECT_EQ(bytes.size(), bytes.find("end_header\n") + 11 + 3 * (12 + 3 + 20));
}

TEST(CloudWriter, WritesCsvOfThePcdsNames) {
  const test::TestFolder folder;
  std::istringstream text(onDisk(folder / "map.csv", kPoints, {Palette::grey, TemperatureSpan{0.0, 100.0}}));
  std::string header, first, second;
  std::getline(text, header);
  std::getline(text, first);
  std::getline(text, second);
  EXPECT_EQ(header, "x,y,z,rgb,temperature,temperature_sigma,count,time");
  EXPECT_THAT(first, testing::StartsWith("1.5,-2.25,3.125,"));
  EXPECT_THAT(first, testing::EndsWith(",20.5,0.25,7,1700000000.250000"));
  EXPECT_EQ(second, "4,5,6,8421504,nan,nan,0,nan");
}

TEST(CloudWriter, WritesEmptyClouds) {
  const test::TestFolder folder;
  onDisk(folder / "map.pcd", {});
  onDisk(folder / "map.ply", {});
  pcl::PCLPointCloud2 cloud;
  EXPECT_EQ(pcl::io::loadPCDFile((folder / "map.pcd").string(), cloud), 0);
  EXPECT_EQ(cloud.width * cloud.height, 0U);
}

TEST(CloudWriter, WritesTheSameBytesTwice) {
  const test::TestFolder folder;
  for (const char* name : {"map.pcd", "map.ply", "map.csv"})
    EXPECT_EQ(onDisk(folder / name), onDisk(folder / name));
}

TEST(CloudWriter, NeverWritesWhite) {
  const test::TestFolder folder;
  std::vector<SurfacePoint> points;
  for (int i = 0; i <= 300; ++i) {
    points.push_back({{0, 0, 0}, SurfaceTemperature{static_cast<float>(i), 0.1F, 1, 0.0}});
  }
  for (const Palette palette : {Palette::inferno, Palette::ironbow, Palette::rainbow, Palette::grey}) {
    const std::string text = onDisk(folder / "map.csv", points, {palette, std::nullopt});
    EXPECT_EQ(text.find(",16777215,"), std::string::npos);
  }
}

TEST(CloudWriter, RefusesOtherEndingsAndFilesThatAreThere) {
  const test::TestFolder folder;
  const auto message = test::messageOf<ConfigError>([&] { onDisk(folder / "map.obj"); });
  EXPECT_THAT(message, HasSubstr("map.obj: the ending is '.obj', expected .pcd, .ply, .las or .csv"));
  folder.write("map.ply", "mine");
  EXPECT_THROW(writeCloud(folder / "map.ply", kPoints, {}, Existing::refuse), DataError);
  EXPECT_EQ(test::bytesOf(folder / "map.ply"), "mine");
}

TEST(CloudWriter, RefusesFoldersThatAreNotThere) {
  const test::TestFolder folder;
  EXPECT_THROW(writeCloud(folder / "no/such/map.ply", kPoints, {}, Existing::refuse), DataError);
}

}  // namespace
}  // namespace thermovox
