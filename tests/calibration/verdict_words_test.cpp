#include "calibration/verdict_words.hpp"

#include <gmock/gmock.h>

#include "tests/calibration/calibration_scene.hpp"

namespace thermovox::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Captures with these boards; nothing but that there is a plane counts.
BundleData dataOf(LaserKind kind, std::size_t planes) {
  BundleData data;
  data.laser = kind;
  data.captures.resize(planes);
  for (CaptureObservations& capture : data.captures) capture.plane.emplace();
  return data;
}

RigEstimate boardsAt(const std::vector<Pose>& boards) {
  RigEstimate estimate;
  estimate.T_reference_board = boards;
  return estimate;
}

Pose tilted(const Eigen::Vector3d& about, double degrees, double distance) {
  return {expRotation(degrees * kDegree * about), {0.0, 0.0, distance}};
}

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX(), kY = Eigen::Vector3d::UnitY();

std::vector<std::string> wordsOf(const std::vector<Pose>& boards) {
  return geometryWords(dataOf(LaserKind::cloud, boards.size()), boardsAt(boards));
}

TEST(TooFewCaptures, KnowsTheFewestOfEveryKind) {
  for (const auto& [kind, fewest] : {std::pair{LaserKind::beam, std::size_t{6}},
                                     {LaserKind::scan, std::size_t{4}},
                                     {LaserKind::cloud, std::size_t{3}}}) {
    EXPECT_FALSE(tooFewCaptures(dataOf(kind, fewest)));
    const auto reason = tooFewCaptures(dataOf(kind, fewest - 1));
    ASSERT_TRUE(reason);
    EXPECT_THAT(*reason, HasSubstr(std::to_string(fewest) + " or more"));
  }
  BundleData data = dataOf(LaserKind::cloud, 3);
  data.captures[1].plane.reset();
  EXPECT_TRUE(tooFewCaptures(data)) << "captures without the board do not count";
}

TEST(RivalWords, SayHowFarApartTheAnswersAre) {
  LaserStart start;
  start.rival = Pose{expRotation({0.0, 90.0 * kDegree, 0.0}), {0.0, 0.0, 0.0}};
  const std::vector<Pose> boards{tilted(kX, 30, 0.6), tilted(kX, -30, 1.0), tilted(kX, 10, 1.8)};
  const std::string words = rivalWords(start, dataOf(LaserKind::cloud, 3), boardsAt(boards));
  EXPECT_THAT(words, HasSubstr("90 degrees away"));
  EXPECT_THAT(words, HasSubstr("about one axis"));
}

TEST(MovedWords, SayHowFarTheReturnsAreOff) {
  const BundleScene scene = made({.captures = 1});
  RigEstimate estimate = scene.truth;
  const Eigen::Vector3d normal = estimate.T_reference_board[0].rotation * Eigen::Vector3d::UnitZ();
  estimate.T_reference_board[0].translation += 0.05 * normal;
  const std::string words = movedWords(*scene.data.captures[0].plane, estimate, 0, 3e-9);
  EXPECT_THAT(words, HasSubstr("up to 50 mm"));
  EXPECT_THAT(words, HasSubstr("3e-09"));
}

TEST(GeometryWords, AreNoneOfBoardsThatAreHeldWell) {
  const std::vector<Pose> good{tilted(kX, 30, 0.6), tilted(kX, -30, 1.0), tilted(kY, 30, 1.4),
                               tilted(kY, -30, 1.8)};
  EXPECT_THAT(wordsOf(good), IsEmpty());
  const std::string refusal = undeterminedWords("rotation", dataOf(LaserKind::cloud, 4), boardsAt(good));
  EXPECT_THAT(refusal, HasSubstr("add captures")) << "a refusal has a reason all the same";
}

TEST(GeometryWords, SayThatBoardsFaceTheSameWay) {
  const auto words = wordsOf({tilted(kX, 2, 0.6), tilted(kX, -2, 1.0), tilted(kY, 2, 1.8)});
  ASSERT_EQ(words.size(), 1U);
  EXPECT_THAT(words.front(), HasSubstr("face about the same way"));
}

TEST(GeometryWords, SayThatBoardsAreTiltedAboutOneAxis) {
  const auto about_x = wordsOf({tilted(kX, 30, 0.6), tilted(kX, -30, 1.0), tilted(kX, 10, 1.8)});
  ASSERT_EQ(about_x.size(), 1U);
  EXPECT_THAT(about_x.front(), HasSubstr("about one axis, the camera's x"));
  const auto about_y = wordsOf({tilted(kY, 30, 0.6), tilted(kY, -30, 1.0), tilted(kY, 10, 1.8)});
  ASSERT_EQ(about_y.size(), 1U);
  EXPECT_THAT(about_y.front(), HasSubstr("about one axis, the camera's y"));
}

TEST(GeometryWords, SayThatBoardsStandAtOneDistance) {
  const auto words =
      wordsOf({tilted(kX, 30, 1.0), tilted(kX, -30, 1.05), tilted(kY, 30, 1.1), tilted(kY, -30, 1.0)});
  ASSERT_EQ(words.size(), 1U);
  EXPECT_THAT(words.front(), HasSubstr("one distance, 1.00 to 1.10 m"));
}

class Describe : public testing::Test {
 protected:
  Describe() {
    verdict_.observable = true;
    verdict_.weakest << 0.0, 0.4 * kDegree, 0.0, 0.001, 0.0, 0.0;
    verdict_.weakest_share = 2.0;
    verdict_.jackknife_ratio = 1.0;
    boards_ = {tilted(kX, 30, 0.6),  tilted(kX, -30, 1.0), tilted(kY, 30, 1.4),
               tilted(kY, -30, 1.8), tilted(kX, 20, 0.8),  tilted(kY, 20, 1.6)};
  }
  /// With what advice asks for besides the boards' places: lens, laser, and the rays that met a board.
  void describeIt() {
    const BundleScene scene = made({.captures = 1});
    BundleData data = dataOf(LaserKind::cloud, boards_.size());
    data.points = scene.data.points;
    for (CaptureObservations& capture : data.captures) capture.plane = scene.data.captures.front().plane;
    RigEstimate estimate = scene.truth;
    estimate.T_reference_board = boards_;
    describe(verdict_, data, estimate, 0.005);
  }

  LaserVerdict verdict_;
  std::vector<Pose> boards_;
};

TEST_F(Describe, NamesTheWeakestDirection) {
  describeIt();
  EXPECT_TRUE(verdict_.observable);
  EXPECT_THAT(verdict_.weakest_direction,
              HasSubstr("rotation about the camera's y (down) axis: 0.4 deg and 1 mm"));
  verdict_.weakest << 0.0, 0.0, 0.0, 0.0, 0.0, 0.02;
  verdict_.warnings.clear();
  describeIt();
  EXPECT_THAT(verdict_.weakest_direction, HasSubstr("translation along the camera's z (forward) axis"));
}

TEST_F(Describe, AsksForMoreCapturesWhereTheyWouldHelp) {
  describeIt();
  EXPECT_THAT(verdict_.warnings, testing::Contains(HasSubstr("6 captures count, 12 or more")));
  EXPECT_THAT(verdict_.warnings, testing::Contains(HasSubstr("not yet known to 0.2 deg")));
  verdict_.warnings.clear();
  verdict_.weakest_share = 0.5;
  describeIt();
  EXPECT_THAT(verdict_.warnings, IsEmpty()) << "six good captures are enough when they are";
}

TEST_F(Describe, RefusesWhatIsNotKnownAtAllWithAReason) {
  verdict_.weakest_share = 60.0;
  boards_ = {tilted(kX, 30, 0.6), tilted(kX, -30, 1.0), tilted(kX, 10, 1.8)};
  describeIt();
  EXPECT_FALSE(verdict_.observable);
  EXPECT_THAT(verdict_.reason, HasSubstr("rotation about"));
  EXPECT_THAT(verdict_.reason, HasSubstr("about one axis"));
}

TEST_F(Describe, WarnsOfCapturesThatScatter) {
  verdict_.jackknife_ratio = 3.1;
  verdict_.jackknife_wins = true;
  verdict_.weakest_share = 0.5;
  describeIt();
  ASSERT_EQ(verdict_.warnings.size(), 1U);
  EXPECT_THAT(verdict_.warnings.front(), HasSubstr("3.1 times"));
}

}  // namespace
}  // namespace thermovox::test
