#include "io/laser_sources.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::HasSubstr;

std::unique_ptr<ReadingSource> source(LaserKind kind, const std::string& text, std::size_t index = 0) {
  Laser laser;
  laser.kind = kind;
  laser.range_min = 0.1;
  laser.range_max = 50.0;
  laser.angle_min = 0.0;
  laser.angle_increment = M_PI / 2;
  laser.time_increment = std::chrono::milliseconds(1);
  return readLaser({"", "rows.csv", std::make_unique<std::istringstream>(text)}, laser, index);
}

std::string complaintAbout(LaserKind kind, const std::string& text) {
  const auto readings = source(kind, text);
  return messageOf<DataError>([&] {
    while (readings->next()) {
    }
  });
}

Time at(double seconds) {
  return Time(durationFromSeconds(seconds));
}

TEST(BeamSource, ReadsRangesWithAndWithoutStrength) {
  const auto readings = source(LaserKind::beam, "timestamp,range\n1.5,2\n2.5,3,99\n", 4);
  const auto first = readings->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp, at(1.5));
  EXPECT_EQ(first->laser, 4U);
  ASSERT_EQ(first->returns.size(), 1U);
  EXPECT_EQ(first->returns[0].p_laser, Eigen::Vector3d(2, 0, 0));
  EXPECT_TRUE(std::isnan(first->returns[0].intensity));
  EXPECT_EQ(readings->next()->returns.at(0).intensity, 99.0F);
  EXPECT_FALSE(readings->next());
}

TEST(BeamSource, AnEmptyStrengthIsNotKnown) {
  const auto reading = source(LaserKind::beam, "1,2,\n")->next();
  ASSERT_EQ(reading->returns.size(), 1U);
  EXPECT_TRUE(std::isnan(reading->returns[0].intensity));
}

TEST(BeamSource, KeepsNegativeStrengthsUnlessTheRigSaysOtherwise) {
  EXPECT_EQ(source(LaserKind::beam, "1,2,-30\n")->next()->returns.size(), 1U);
}

TEST(BeamSource, CountsWhatIsNoReturn) {
  const auto readings = source(LaserKind::beam, "1,inf\n2,nan\n3,0\n4,-1\n5,0.01\n6,99\n");
  DroppedReturns dropped;
  while (const auto reading = readings->next()) {
    EXPECT_TRUE(reading->returns.empty());
    dropped += reading->dropped;
  }
  EXPECT_EQ(dropped.no_return, 4U);
  EXPECT_EQ(dropped.too_near, 1U);
  EXPECT_EQ(dropped.too_far, 1U);
}

TEST(BeamSource, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(complaintAbout(LaserKind::beam, "1,2\n2,far\n"), HasSubstr("rows.csv:2: found 'far'"));
  EXPECT_THAT(complaintAbout(LaserKind::beam, "1,2\n2\n"), HasSubstr("rows.csv:2: has 1 field(s)"));
  EXPECT_THAT(complaintAbout(LaserKind::beam, "1,2,3,4\n"), HasSubstr("rows.csv:1: has 4 field(s)"));
  EXPECT_THAT(complaintAbout(LaserKind::beam, "2,2\n1,2\n"),
              HasSubstr("rows.csv:2: timestamp 1.000000000 follows"));
  EXPECT_THAT(complaintAbout(LaserKind::beam, "1,2\nnan,2\n"),
              HasSubstr("rows.csv:2: found 'nan', expected a timestamp"));
}

TEST(ScanSource, ReadsRowsOfVaryingLengthWithATimeForEachRange) {
  const auto readings = source(LaserKind::scan, "timestamp,ranges...\n1,2,inf,4\n2,5\n");
  const auto first = readings->next();
  ASSERT_TRUE(first);
  ASSERT_EQ(first->returns.size(), 2U);
  EXPECT_EQ(first->dropped.no_return, 1U);
  EXPECT_EQ(first->returns[1].stamp, at(1.002));
  EXPECT_NEAR(first->returns[1].p_laser.x(), -4.0, 1e-12);
  EXPECT_EQ(readings->next()->returns.size(), 1U);
  EXPECT_FALSE(readings->next());
}

TEST(ScanSource, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(complaintAbout(LaserKind::scan, "1,2,x\n"), HasSubstr("rows.csv:1: found 'x' as field 3"));
  EXPECT_THAT(complaintAbout(LaserKind::scan, "1,2,\n"), HasSubstr("rows.csv:1: found '' as field 3"));
  EXPECT_THAT(complaintAbout(LaserKind::scan, "1,2\n2\n"), HasSubstr("rows.csv:2: has a timestamp only"));
}

TEST(CloudSource, ReadsCloudsBesideTheList) {
  const test::TestFolder folder;
  folder.write(
      "clouds/a.ply",
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float time\nend_header\n1 0 0 0.0\n0 1 0 0.05\n");
  Laser laser;
  laser.kind = LaserKind::cloud;
  const auto open = [&](const char* text) {
    return readLaser({folder.path(), "clouds.csv", std::make_unique<std::istringstream>(text)}, laser, 0);
  };
  const auto reading = open("timestamp,file\n10,clouds/a.ply\n")->next();
  ASSERT_TRUE(reading);
  ASSERT_EQ(reading->returns.size(), 2U);
  EXPECT_EQ(reading->returns[1].stamp, at(10.05));
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(open("10,clouds/b.ply\n")->next()); }),
              HasSubstr("clouds/b.ply (named by clouds.csv:1): no such file"));
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(open("10,\n")->next()); }),
              HasSubstr("clouds.csv:1: names no file, expected timestamp,file"));
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(open("10,clouds/a.ply,0\n")->next()); }),
              HasSubstr("clouds.csv:1: has 3 field(s), expected timestamp,file"));
}

TEST(MergeReadings, OrdersByTimeAndThenByLaser) {
  std::vector<std::unique_ptr<ReadingSource>> sources;
  sources.push_back(source(LaserKind::beam, "1,1\n3,1\n4,1\n", 0));
  sources.push_back(source(LaserKind::beam, "", 1));
  sources.push_back(source(LaserKind::beam, "0.5,1\n3,1\n5,1\n", 2));
  const auto merged = mergeReadings(std::move(sources));
  std::vector<std::pair<double, std::size_t>> order;
  while (const auto reading = merged->next())
    order.emplace_back(toUnixSeconds(reading->stamp), reading->laser);
  EXPECT_THAT(order, testing::ElementsAre(std::pair(0.5, 2), std::pair(1.0, 0), std::pair(3.0, 0),
                                          std::pair(3.0, 2), std::pair(4.0, 0), std::pair(5.0, 2)));
}

}  // namespace
}  // namespace thermovox
