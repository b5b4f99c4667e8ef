#include "io/board_yaml.hpp"

#include <gmock/gmock.h>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

CalibrationBoard boardOf(const std::string& flow) {
  return readBoard(YamlMap::parse("board: {" + flow + "}\n", "captures.yaml").map("board"));
}

std::string complaintAbout(const std::string& flow) {
  return messageOf<ConfigError>([&] { (void)boardOf(flow); });
}

TEST(ReadBoard, MakesThePlateOfTheMargin) {
  const CalibrationBoard chess =
      boardOf("pattern: chessboard, inner_corners: [9, 6], square: 0.04, margin: 0.02");
  EXPECT_EQ(chess.pattern, CalibrationBoard::Pattern::chessboard);
  EXPECT_EQ(chess.columns, 9);
  EXPECT_EQ(chess.rows, 6);
  EXPECT_EQ(chess.square, 0.04);
  EXPECT_DOUBLE_EQ(chess.width, 0.44);
  EXPECT_DOUBLE_EQ(chess.height, 0.32);
  const CalibrationBoard circles =
      boardOf("pattern: asymmetric_circles, circles: [4, 11], square: 0.02, margin: 0.05");
  EXPECT_EQ(circles.pattern, CalibrationBoard::Pattern::asymmetric_circles);
  EXPECT_DOUBLE_EQ(circles.width, 0.24);  // seven half distances, and twice the margin
  EXPECT_DOUBLE_EQ(circles.height, 0.30);
}

TEST(ReadBoard, TakesThePlateAsItIsSaidOrLeavesItUnknown) {
  const CalibrationBoard said =
      boardOf("pattern: chessboard, inner_corners: [7, 5], square: 0.095, width: 0.85, height: 0.61");
  EXPECT_EQ(said.width, 0.85);
  EXPECT_EQ(said.height, 0.61);
  const CalibrationBoard unknown =
      boardOf("pattern: asymmetric_circles, inner_corners: [4, 11], square: 0.02");
  EXPECT_EQ(unknown.rows, 11);
  EXPECT_EQ(unknown.width, 0.0);
  EXPECT_EQ(unknown.height, 0.0);
}

TEST(ReadBoard, RefusesAPlateThatIsSmallerThanItsPattern) {
  EXPECT_THAT(
      complaintAbout("pattern: chessboard, inner_corners: [9, 6], square: 0.04, width: 0.39, height: 1"),
      HasSubstr("captures.yaml, board.width: is 0.39 m, expected a plate from the size of its pattern"));
  EXPECT_THAT(
      complaintAbout("pattern: chessboard, inner_corners: [9, 6], square: 0.04, width: 1, height: 300"),
      HasSubstr("board.height: is 300 m"));
  // A plate that ends with the outer squares, to the digit.
  EXPECT_EQ(
      boardOf("pattern: chessboard, inner_corners: [9, 6], square: 0.04, width: 0.4, height: 0.28").width,
      0.4);
}

TEST(ReadBoard, RefusesAQuarterTurnThatNobodyCanTell) {
  const std::string grid = "pattern: chessboard, inner_corners: [6, 6], square: 0.04, ";
  EXPECT_THAT(complaintAbout(grid + "width: 0.4, height: 0.3"),
              AllOf(HasSubstr("captures.yaml, board: has as many rows as columns on a plate of 0.4 x 0.3 m"),
                    HasSubstr("cannot be told apart when turned by 90 degrees")));
  EXPECT_EQ(boardOf(grid + "width: 0.4, height: 0.4").columns, 6);
  EXPECT_EQ(boardOf(grid + "margin: 0.1").columns, 6);
}

TEST(ReadBoard, RefusesAbsurdNumbers) {
  const std::string chess = "pattern: chessboard, square: 0.04, inner_corners: ";
  for (const char* counts : {"[2, 6]", "[9, 65]", "[9.5, 6]", "[-9, 6]"}) {
    EXPECT_THAT(complaintAbout(chess + counts), HasSubstr("expected whole numbers from 3 to 64")) << counts;
  }
  EXPECT_THAT(complaintAbout(chess + "[9]"), HasSubstr("has 1 numbers, expected 2"));
  EXPECT_THAT(complaintAbout(chess + "[9, 6], margin: -0.1"), HasSubstr("board.margin: is -0.1 m"));
  for (const char* square : {"0", "-0.04", "40"}) {
    EXPECT_THAT(complaintAbout("pattern: chessboard, inner_corners: [9, 6], square: " + std::string(square)),
                HasSubstr("expected more than 0 and at most 2 m"));
  }
  EXPECT_THAT(complaintAbout("pattern: chessboard, inner_corners: [9, 6], square: .nan"),
              HasSubstr("expected a finite number"));
}

TEST(ReadBoard, RefusesWhatBoardsDoNotSay) {
  const std::string chess = "pattern: chessboard, inner_corners: [9, 6], square: 0.04";
  EXPECT_THAT(complaintAbout("pattern: dots, inner_corners: [9, 6], square: 0.04"),
              HasSubstr("board.pattern: found 'dots', expected chessboard or asymmetric_circles"));
  EXPECT_THAT(complaintAbout(chess + ", squares: 3"), HasSubstr("board: unknown key 'squares'"));
  EXPECT_THAT(complaintAbout(chess + ", margin: 0.1, width: 1"), HasSubstr("margin: is given beside width"));
  EXPECT_THAT(complaintAbout(chess + ", width: 1"), HasSubstr("board.height: is missing"));
  EXPECT_THAT(complaintAbout("pattern: chessboard, circles: [9, 6], square: 0.04"),
              HasSubstr("board.circles: is given for a chessboard"));
  EXPECT_THAT(
      complaintAbout("pattern: asymmetric_circles, circles: [4, 11], inner_corners: [4, 11], square: 0.04"),
      HasSubstr("board.circles: is given beside inner_corners"));
  EXPECT_THAT(complaintAbout("pattern: chessboard, square: 0.04"),
              HasSubstr("board.inner_corners: is missing"));
}

}  // namespace
}  // namespace thermovox
