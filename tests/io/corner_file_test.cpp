#include "io/corner_file.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::HasSubstr;

const CalibrationBoard kBoard{.columns = 3, .rows = 3, .square = 0.1};
constexpr const char* kCorners = "u,v\n1,2\n2,2\n3,2\n1,3.5\n2,3.5\n3,3.5\n1,5\n2,5\n3,-0.25\n";

std::vector<Eigen::Vector2d> cornersOf(const std::string& text) {
  return readCorners(std::make_unique<std::istringstream>(text), "corners.csv", kBoard);
}

std::string complaintAbout(const std::string& text) {
  return messageOf<DataError>([&] { (void)cornersOf(text); });
}

TEST(ReadCorners, GoesRowByRowOfTheBoard) {
  const auto corners = cornersOf(kCorners);
  ASSERT_EQ(corners.size(), 9U);
  EXPECT_EQ(corners[0], Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(corners[4], Eigen::Vector2d(2.0, 3.5));
  EXPECT_EQ(corners[8], Eigen::Vector2d(3.0, -0.25));
  EXPECT_EQ(cornersOf(std::string(kCorners).substr(4)), corners);  // without a header
}

TEST(ReadCorners, ReadsAFileAndNamesWhoWantsIt) {
  const test::TestFolder folder;
  EXPECT_EQ(readCorners(folder.write("c.csv", kCorners), kBoard).size(), 9U);
  EXPECT_THAT(messageOf<DataError>([&] { (void)readCorners(folder / "none.csv", kBoard, "captures.csv:2"); }),
              HasSubstr("none.csv (named by captures.csv:2): no such file"));
}

TEST(ReadCorners, RefusesAnotherNumberThanTheBoardHas) {
  const std::string all(kCorners);
  EXPECT_EQ(complaintAbout(all + "4,4\n"), "corners.csv: has 10 corner(s), expected 9, 3 in each of 3 rows");
  EXPECT_EQ(complaintAbout("u,v\n1,2\n"), "corners.csv: has 1 corner(s), expected 9, 3 in each of 3 rows");
  EXPECT_THAT(complaintAbout(""), HasSubstr("has 0 corner(s)"));
  EXPECT_THAT(complaintAbout(all.substr(0, all.size() / 2)), HasSubstr("corners.csv"));  // cut off
}

TEST(ReadCorners, RefusesWhatIsNoPixel) {
  EXPECT_EQ(complaintAbout("1,2\n3\n"), "corners.csv:2: has 1 field(s), expected u,v");
  EXPECT_THAT(complaintAbout("1,2,3\n"), HasSubstr("corners.csv:1: has 3 field(s)"));
  EXPECT_THAT(complaintAbout("1,2\n3,\n"),
              HasSubstr("corners.csv:2: found '' as field 2, expected a number"));
  EXPECT_EQ(complaintAbout("1,inf\n"), "corners.csv:1: is not finite, expected a pixel");
}

}  // namespace
}  // namespace thermovox
