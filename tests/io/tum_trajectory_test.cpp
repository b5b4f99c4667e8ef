#include "io/tum_trajectory.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::HasSubstr;

std::vector<StampedPose> read(const std::string& text) {
  std::istringstream stream(text);
  return readTumTrajectory(stream, "t.tum");
}

std::string complaintAbout(const std::string& text) {
  return messageOf<DataError>([&] { static_cast<void>(read(text)); });
}

TEST(ReadTumTrajectory, ReadsPosesBetweenCommentsAndBlankLines) {
  const auto poses =
      read("# timestamp ...\r\n\r\n1.5 1 2 3 0 0 0 1\r\n  # more\n\t2.5  4 5 6  0 0 0.6 0.8 \n");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].stamp.time_since_epoch(), std::chrono::milliseconds(1500));
  EXPECT_EQ(poses[0].T_world_body.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(poses[1].T_world_body.rotation.z(), 0.6);
  EXPECT_EQ(poses[1].T_world_body.rotation.w(), 0.8);
}

TEST(ReadTumTrajectory, NormalisesARoundedQuaternion) {
  const auto poses = read("1 0 0 0 0 0 0.7071 0.7071");
  EXPECT_NEAR(poses.at(0).T_world_body.rotation.norm(), 1.0, 1e-15);
}

TEST(ReadTumTrajectory, NamesTheLineOfAQuaternionThatIsNone) {
  EXPECT_THAT(complaintAbout("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1.02\n"),
              HasSubstr("t.tum:2: the quaternion x y z w = 0 0 0 1.02 has norm 1.02, expected 1 within 1 %"));
  EXPECT_THAT(complaintAbout("1 0 0 0 0 0 0 0"), HasSubstr("norm 0"));
}

TEST(ReadTumTrajectory, RefusesTimesThatDoNotAscend) {
  EXPECT_THAT(complaintAbout("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
              HasSubstr("t.tum:2: timestamp 1.000000000 follows 2.000000000"));
  EXPECT_THAT(complaintAbout("2 0 0 0 0 0 0 1\n2.0 0 0 0 0 0 0 1\n"), HasSubstr("t.tum:2: timestamp 2.0"));
}

TEST(ReadTumTrajectory, RefusesNumbersThatAreNotFinite) {
  EXPECT_THAT(complaintAbout("1 0 nan 0 0 0 0 1"),
              HasSubstr("t.tum:1: found 'nan', expected a finite number"));
  EXPECT_THAT(complaintAbout("1 0 inf 0 0 0 0 1"), HasSubstr("found 'inf'"));
  EXPECT_THAT(complaintAbout("nan 0 0 0 0 0 0 1"), HasSubstr("found 'nan', expected a timestamp"));
}

TEST(ReadTumTrajectory, RefusesAnotherNumberOfColumns) {
  EXPECT_THAT(complaintAbout("1 0 0 0 0 0 1"), HasSubstr("t.tum:1: has 7 columns, expected 8"));
  EXPECT_THAT(complaintAbout("1 0 0 0 0 0 0 1 9 9"), HasSubstr("has 10 columns"));
  EXPECT_THAT(complaintAbout("1 0 0 0 0 0 0 1\n2 0 0"), HasSubstr("t.tum:2: has 3 columns"));  // cut off
}

TEST(ReadTumTrajectory, RefusesAFileWithoutPoses) {
  EXPECT_THAT(complaintAbout(""), HasSubstr("t.tum: holds no pose"));
  EXPECT_THAT(complaintAbout("# only\n"), HasSubstr("holds no pose"));
}

TEST(ReadTumTrajectory, NamesTheFileThatIsNotThere) {
  const test::TestFolder folder;
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(readTumTrajectory(folder / "no.tum")); }),
              HasSubstr("no.tum: no such file"));
}

TEST(ReadTumTrajectory, ReadsTheRecordings) {
  THERMOVOX_NEEDS_RECORDINGS();
  EXPECT_EQ(readTumTrajectory(*test::recordings() / "missions/hall-beam/trajectory.tum").size(), 610U);
  EXPECT_EQ(readTumTrajectory(*test::recordings() / "missions/intel/trajectory.tum").size(), 906U);
}

}  // namespace
}  // namespace thermovox
