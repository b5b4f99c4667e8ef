// Which frame colours which return.
#include "mapping/mission_mapper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <variant>
#include <vector>

#include "tests/mapping/synthetic_mission.hpp"

namespace thermovox::test {
namespace {

TEST(MissionMapper, AReturnTakesTheTemperatureOfTheFrameNearestInTime) {
  const Mission mission = missionOf(poses(0.1, 0.0));
  std::vector<ThermalFrame> frames;
  std::vector<Reading> readings;
  for (int i = 0; i < 10; ++i) frames.push_back(frameAt(12.0 + kPeriod * i, 100.0 + i));
  for (int i = 0; i < 180; ++i) readings.push_back(readingAt(12.003 + 0.01 * i));
  const Result result = mapAll(mission, readings, frames);
  ASSERT_EQ(result.report.coloured, 180U);
  for (const ColouredReturn& point : result.points) {
    const double nearest = std::round((toSeconds(point.placed.stamp - at(12.0))) / kPeriod);
    SCOPED_TRACE(formatTime(point.placed.stamp));
    EXPECT_FLOAT_EQ(point.colour->celsius, static_cast<float>(100.0 + nearest));
    EXPECT_EQ(point.colour->frame_stamp, at(12.0) + durationFromSeconds(kPeriod * nearest));
  }
}

TEST(MissionMapper, AFrameColoursUpToHalfAPeriodAndFiftyMillisecondsAway) {
  const Mission mission = missionOf(poses(0.0, 0.0));
  const auto colouredAt = [&](double seconds, const MissionMapper::Options& options) {
    return mapAll(mission, {readingAt(seconds)}, {frameAt(13.0, 30.0)}, options).report.coloured == 1;
  };
  EXPECT_TRUE(colouredAt(13.150, {}));
  EXPECT_TRUE(colouredAt(12.850, {}));
  EXPECT_FALSE(colouredAt(13.151, {}));
  EXPECT_FALSE(colouredAt(12.849, {}));
  EXPECT_TRUE(colouredAt(13.4, {.frame_limit = durationFromSeconds(0.4)}));
  EXPECT_FALSE(colouredAt(13.1, {.frame_limit = durationFromSeconds(0.05)}));
}

TEST(MissionMapper, AFrameWithoutAPoseIsCountedAndColoursNothing) {
  const Result result = mapAll(missionOf(poses(0.0, 0.0)), {readingAt(10.0), readingAt(15.0)},
                               {frameAt(9.95, 30.0), frameAt(15.0, 50.0), frameAt(21.0, 70.0)});
  EXPECT_EQ(result.report.frames, 3U);
  EXPECT_EQ(result.report.frames_without_pose, 2U);
  EXPECT_EQ(result.report.coloured, 1U);
  EXPECT_EQ(result.report.uncoloured, (std::map<std::string, std::size_t>{{"no_pose_for_frame", 1}}));
}

TEST(MissionMapper, TemperaturesThatTheCameraIsNotCalibratedForAreTakenAndCounted) {
  const auto framed = [](double stamp, double celsius) {
    ThermalFrame frame = frameAt(stamp, celsius);
    ThermalImage image = *frame.image;
    image.calibrated_range = CalibratedRange{-20.0, 120.0};
    frame.image = std::make_shared<const ThermalImage>(std::move(image));
    return frame;
  };
  const Result result =
      mapAll(missionOf(poses(0.0, 0.0)), {readingAt(13.0, 2), readingAt(14.0, 3), readingAt(15.0, 4)},
             {framed(13.0, 130.0), framed(14.0, 20.0), framed(15.0, -30.0)});
  EXPECT_EQ(result.report.coloured, 9U);
  EXPECT_EQ(result.report.outside_calibration, 6U);
  EXPECT_FLOAT_EQ(result.points[0].colour->celsius, 130.0F);
  EXPECT_EQ(mapAll(missionOf(poses(0.0, 0.0)), {readingAt(13.0)}, {frameAt(13.0, 900.0)})
                .report.outside_calibration,
            0U)
      << "of a camera that does not say";
}

TEST(MissionMapper, TheCameraStandsWhereItWasWhenTheFrameWasTaken) {
  const Mission mission = missionOf(poses(2.0, 0.1));
  const ThermalCamera& camera = *mission.rig.thermal_camera;
  const Result result = mapAll(mission, {readingAt(13.05, 5), readingAt(13.16, 5)}, {frameAt(13.1, 30.0)});
  ASSERT_EQ(result.report.coloured, 10U);
  const Pose T_world_body = std::get<Pose>(mission.trajectory.at(at(13.1)));
  const Pose T_camera_world = (T_world_body * camera.T_body_camera).inverse();
  for (const ColouredReturn& point : result.points) {
    const auto expected = camera.camera.project(T_camera_world * point.placed.p_world);
    ASSERT_TRUE(expected && point.colour);
    EXPECT_LT((point.colour->pixel - *expected).norm(), 1e-9);
    EXPECT_NEAR(point.colour->range, (T_camera_world * point.placed.p_world).norm(), 1e-6);
  }
}

TEST(MissionMapper, APointThatTheNearestFrameDoesNotSeeTakesAnotherFramesTemperature) {
  // The body turns by 4 rad/s: 0.2 s after a return the camera has turned away from its point by 46 degrees.
  const Mission mission = missionOf(poses(0.0, 4.0));
  const MissionMapper::Options patient{.frame_limit = durationFromSeconds(0.25)};
  const std::vector<ThermalFrame> frames{frameAt(13.0, 30.0), frameAt(13.35, 60.0)};
  // At 13.2 s the nearest frame is the second, 34 degrees on; the first is 46 degrees back; the image reaches
  // 38 degrees to both sides of its middle. A point 20 degrees to the right of the axis is outside the
  // second.
  Reading right{.stamp = at(13.2)};
  right.returns.push_back({at(13.2), {kWall * std::cos(0.35), -kWall * std::sin(0.35), 0.0}});
  const Result result = mapAll(mission, {right}, frames, patient);
  ASSERT_EQ(result.report.coloured, 1U);
  EXPECT_EQ(result.points[0].colour->celsius, 30.0F);
  EXPECT_EQ(result.points[0].colour->frame_stamp, at(13.0));
  const Result impatient = mapAll(mission, {right}, frames, {.frame_limit = durationFromSeconds(0.18)});
  EXPECT_EQ(impatient.report.uncoloured, (std::map<std::string, std::size_t>{{"outside_image", 1}}));
}

TEST(MissionMapper, NoNaNGetsIntoTheMapsStatistics) {
  const Mission mission = missionOf(poses(0.6, 0.3));
  const Camera camera = wideCamera();
  std::mt19937 rng(3);
  std::bernoulli_distribution unknown(0.6);
  std::vector<ThermalFrame> frames;
  for (int i = 0; i < 20; ++i) {
    const auto celsius = [&](int u, int) {
      return unknown(rng) ? std::numeric_limits<double>::quiet_NaN() : 20.0 + u;
    };
    frames.push_back(frameOf(imageOf(camera.width(), camera.height(), celsius), at(12.0 + kPeriod * i)));
  }
  std::vector<Reading> readings;
  for (int i = 0; i < 400; ++i) readings.push_back(readingAt(12.0 + 0.01 * i, 9));
  const Result result = mapAll(mission, readings, frames);
  expectAccountOfEveryPoint(result.report);
  EXPECT_GT(result.report.coloured, 100U);
  EXPECT_GT(result.report.uncoloured.at("unknown_pixel"), 100U);
  std::size_t warm = 0;
  forEachSurface(result.map, [&warm](const CellKey&, const SurfaceCell& cell) {
    ASSERT_GT(cell.returns, 0U);
    if (cell.observations == 0) return;
    ++warm;
    ASSERT_TRUE(std::isfinite(cell.mean()) && std::isfinite(cell.sigmaOfMean()) &&
                std::isfinite(cell.spread()));
    ASSERT_GE(cell.mean(), 20.0);
    ASSERT_LE(cell.mean(), 83.0);
  });
  EXPECT_GT(warm, 20U);
}

}  // namespace
}  // namespace thermovox::test
