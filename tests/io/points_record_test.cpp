#include "io/points_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/io/ply_io.h>

#include <cstring>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

ColouredReturn pointAt(std::int64_t nanoseconds, double x, bool coloured = true) {
  ColouredReturn point;
  point.placed.stamp = Time(Duration(nanoseconds));
  point.placed.p_world = {x, -2.25, 0.00004};
  point.placed.origin_world = Eigen::Vector3d::Zero();
  point.placed.rig_covariance = 1e-4 * Eigen::Matrix3d::Identity();
  point.placed.pose_covariance = Eigen::Matrix3d::Zero();
  point.placed.range = 7.12345;
  if (coloured) {
    point.colour = Colour{.frame_stamp = point.placed.stamp,
                          .pixel = {12.3456, 7.0},
                          .celsius = 44.1504F,
                          .sigma = 0.123456F,
                          .range = 7.5F};
  }
  return point;
}

constexpr std::int64_t kStart = 1'760'000'000'123'456'789;

std::vector<std::string> linesOf(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> namesIn(const test::TestFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path())) names.push_back(entry.path().filename());
  return names;
}

TEST(PointsRecord, CsvHasTheColumnsOfTheFormatAndEnoughDecimals) {
  const test::TestFolder folder;
  PointsRecord record(folder / "points.csv", RecordedPoints::coloured, Existing::refuse);
  record.add(std::vector{pointAt(kStart, 1.00005)});
  record.finish();
  record.commit();
  EXPECT_THAT(linesOf(folder / "points.csv"),
              ElementsAre("timestamp,x,y,z,range,u,v,temperature,sigma",
                          "1760000000.123456789,1.0001,-2.2500,0.0000,7.1235,12.346,7.000,44.150,0.1235"));
}

TEST(PointsRecord, PointsWithoutTemperatureAreLeftOutOrHaveEmptyFields) {
  const test::TestFolder folder;
  for (const RecordedPoints which : {RecordedPoints::coloured, RecordedPoints::all}) {
    PointsRecord record(folder / "points.csv", which, Existing::replace);
    record.add(std::vector{pointAt(kStart, 1.0, false), pointAt(kStart + 1, 2.0)});
    record.finish();
    record.commit();
    const std::vector<std::string> lines = linesOf(folder / "points.csv");
    const bool all = which == RecordedPoints::all;
    ASSERT_EQ(lines.size(), all ? 3U : 2U);
    if (all) {
      EXPECT_EQ(lines[1], "1760000000.123456789,1.0000,-2.2500,0.0000,7.1235,,,,");
    }
    EXPECT_THAT(lines.back(), HasSubstr("1760000000.123456790,2.0000"));
  }
}

/// Sweeps of 100 ms that follow each other; within a sweep the points are in any order, and the last ones of
/// a sweep come after the first of the next.
std::vector<std::vector<ColouredReturn>> overlappingSweeps() {
  std::mt19937 rng(4);
  std::vector<std::vector<ColouredReturn>> sweeps;
  for (int i = 0; i < 30; ++i) {
    std::uniform_int_distribution<std::int64_t> within(0, 150'000'000);
    std::vector<ColouredReturn>& sweep = sweeps.emplace_back();
    for (int j = 0; j < 200; ++j) {
      const std::int64_t offset = j == 77 ? 0 : within(rng);
      sweep.push_back(pointAt(kStart + i * 100'000'000LL + offset, i, j % 3 != 0));
    }
  }
  return sweeps;
}

TEST(PointsRecord, RowsAreInTimeOrderWithinAndAcrossReadings) {
  const test::TestFolder folder;
  PointsRecord record(folder / "points.csv", RecordedPoints::all, Existing::refuse);
  for (const auto& sweep : overlappingSweeps()) record.add(sweep);
  record.finish();
  record.commit();
  const std::vector<std::string> lines = linesOf(folder / "points.csv");
  ASSERT_EQ(lines.size(), 1U + 30U * 200U);
  std::string previous;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::string stamp = lines[i].substr(0, lines[i].find(','));
    ASSERT_EQ(stamp.size(), 20U);  // so that the order of the texts is that of the numbers
    ASSERT_LE(previous, stamp);
    previous = stamp;
  }
}

/// A field of every point of a cloud, as double.
std::vector<double> fieldOf(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  std::vector<double> values;
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name != name) continue;
    for (std::size_t i = 0; i < std::size_t{cloud.width} * cloud.height; ++i) {
      const std::uint8_t* place = cloud.data.data() + i * cloud.point_step + field.offset;
      if (field.datatype == pcl::PCLPointField::FLOAT64) {
        double value = 0.0;
        std::memcpy(&value, place, sizeof value);
        values.push_back(value);
      } else {
        EXPECT_EQ(field.datatype, pcl::PCLPointField::FLOAT32) << name;
        float value = 0.0F;
        std::memcpy(&value, place, sizeof value);
        values.push_back(value);
      }
    }
  }
  return values;
}

TEST(PointsRecord, PclReadsThePlyBackWithDoubleCoordinatesAndStamps) {
  const test::TestFolder folder;
  PointsRecord record(folder / "points.ply", RecordedPoints::all, Existing::refuse);
  const double x = 1234567.123456789;  // more than a float holds
  record.add(std::vector{pointAt(kStart, x), pointAt(kStart + 1'000'000, x + 1e-6, false)});
  record.add(std::vector{pointAt(kStart + 2'000'000, 3.0)});
  record.finish();
  record.commit();
  pcl::PCLPointCloud2 cloud;
  ASSERT_EQ(pcl::PLYReader().read((folder / "points.ply").string(), cloud), 0);
  ASSERT_EQ(cloud.width * cloud.height, 3U);
  EXPECT_THAT(fieldOf(cloud, "x"), ElementsAre(x, x + 1e-6, 3.0));
  EXPECT_THAT(fieldOf(cloud, "z"), ElementsAre(0.00004, 0.00004, 0.00004));
  const auto seconds = [](std::int64_t ns) { return toUnixSeconds(Time(Duration(ns))); };
  EXPECT_THAT(fieldOf(cloud, "timestamp"),
              ElementsAre(seconds(kStart), seconds(kStart + 1'000'000), seconds(kStart + 2'000'000)));
  EXPECT_THAT(fieldOf(cloud, "scalar_temperature"), ElementsAre(44.1504F, testing::IsNan(), 44.1504F));
  EXPECT_THAT(fieldOf(cloud, "scalar_sigma"), ElementsAre(0.123456F, testing::IsNan(), 0.123456F));
  EXPECT_THAT(fieldOf(cloud, "scalar_range"), ElementsAre(7.12345F, 7.12345F, 7.12345F));
  EXPECT_THAT(fieldOf(cloud, "scalar_u"), ElementsAre(12.3456F, testing::IsNan(), 12.3456F));
}

TEST(PointsRecord, PlyHoldsAsManyPointsAsItsHeaderSays) {
  const test::TestFolder folder;
  PointsRecord record(folder / "points.ply", RecordedPoints::coloured, Existing::refuse);
  std::size_t coloured = 0;
  for (const auto& sweep : overlappingSweeps()) {
    record.add(sweep);
    for (const ColouredReturn& point : sweep) coloured += point.colour.has_value();
  }
  record.finish();
  record.commit();
  const std::string bytes = test::bytesOf(folder / "points.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  EXPECT_EQ(bytes.size() - body, coloured * (4 * sizeof(double) + 5 * sizeof(float)));
  EXPECT_THAT(bytes, HasSubstr("element vertex " + std::to_string(coloured) + "\n"));
}

TEST(PointsRecord, ARecordWithoutPointsIsStillAFile) {
  const test::TestFolder folder;
  for (const char* name : {"none.csv", "none.ply"}) {
    PointsRecord record(folder / name, RecordedPoints::coloured, Existing::refuse);
    record.add({});
    record.add(std::vector{pointAt(kStart, 1.0, false)});
    record.finish();
    record.commit();
  }
  EXPECT_EQ(linesOf(folder / "none.csv").size(), 1U);
  EXPECT_THAT(test::bytesOf(folder / "none.ply"), HasSubstr("element vertex 0\n"));
}

TEST(PointsRecord, WithoutCommitNothingIsLeftBehind) {
  const test::TestFolder folder;
  {
    PointsRecord record(folder / "points.csv", RecordedPoints::all, Existing::refuse);
    for (const auto& sweep : overlappingSweeps()) record.add(sweep);
    EXPECT_FALSE(fs::exists(folder / "points.csv"));
  }
  EXPECT_THAT(namesIn(folder), testing::IsEmpty());
}

TEST(PointsRecord, FinishBringsAllToTheDiskWithoutTheName) {
  const test::TestFolder folder;
  for (const char* name : {"points.csv", "points.ply"}) {
    PointsRecord record(folder / name, RecordedPoints::coloured, Existing::refuse);
    record.add(std::vector{pointAt(kStart, 1.0), pointAt(kStart + 5, 2.0)});
    record.finish();
    EXPECT_FALSE(fs::exists(folder / name));
    record.commit();
  }
  EXPECT_EQ(linesOf(folder / "points.csv").size(), 3U);
  EXPECT_EQ(namesIn(folder).size(), 2U);
}

TEST(PointsRecord, EndingsAreReadWhateverTheirCase) {
  const test::TestFolder folder;
  PointsRecord record(folder / "POINTS.PLY", RecordedPoints::all, Existing::refuse);
  record.finish();
  record.commit();
  EXPECT_THAT(test::bytesOf(folder / "POINTS.PLY"), testing::StartsWith("ply\n"));
}

TEST(PointsRecord, AnExistingFileIsKeptUnlessItMayBeReplaced) {
  const test::TestFolder folder;
  const fs::path file = folder.write("points.csv", "precious");
  EXPECT_THAT(
      test::messageOf<DataError>([&] { PointsRecord record(file, RecordedPoints::all, Existing::refuse); }),
      HasSubstr("points.csv: exists already"));
  EXPECT_EQ(test::bytesOf(file), "precious");
  PointsRecord record(file, RecordedPoints::all, Existing::replace);
  EXPECT_EQ(test::bytesOf(file), "precious");  // until the new one is whole
  record.finish();
  record.commit();
  EXPECT_EQ(test::bytesOf(file), "timestamp,x,y,z,range,u,v,temperature,sigma\n");
  EXPECT_THAT(namesIn(folder), ElementsAre("points.csv"));
}

TEST(PointsRecord, AnEndingThatIsNoRecordIsRefusedAndLeavesNothing) {
  const test::TestFolder folder;
  EXPECT_THAT(test::messageOf<ConfigError>(
                  [&] { PointsRecord record(folder / "points.txt", RecordedPoints::all, Existing::refuse); }),
              testing::AllOf(HasSubstr("points.txt"), HasSubstr(".csv or .ply"), HasSubstr("'.txt'")));
  EXPECT_THAT(namesIn(folder), testing::IsEmpty());
  EXPECT_THAT(test::messageOf<DataError>([&] {
                PointsRecord record(folder / "no_folder" / "points.csv", RecordedPoints::all,
                                    Existing::refuse);
              }),
              HasSubstr("does not exist"));
}

}  // namespace
}  // namespace thermovox
