#include "mapping/mission_mapper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "projection/error.hpp"
#include "tests/projection/scene.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

constexpr double kPeriod = 0.2;  // seconds from frame to frame
constexpr double kWall = 5.0;    // metres; a wall across x, and the camera looks along x

Time at(double seconds) {
  return Time(durationFromSeconds(seconds));
}

Camera wideCamera() {
  Intrinsics intrinsics{.width_px = 64, .height_px = 48};
  intrinsics.parameters = {40.0, 40.0, 31.5, 23.5};
  return Camera(intrinsics);
}

/// The optical frame looks along the body's x.
Pose lookingAhead() {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(R_body_camera), {0.1, 0.0, 0.05}};
}

/// A body that moves along y by `speed` (m/s) and turns about z by `turn` (rad/s), with poses at 100 Hz from
/// 10 s to 20 s.
std::vector<StampedPose> poses(double speed, double turn) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.01 * i;
    const Eigen::AngleAxisd rotation(turn * t, Eigen::Vector3d::UnitZ());
    poses.push_back({at(10.0 + t), {Eigen::Quaterniond(rotation), {0.0, speed * t, 1.0}}});
  }
  return poses;
}

Mission missionOf(std::vector<StampedPose> poses) {
  Mission mission{.name = "synthetic"};
  mission.rig.lasers.push_back(Laser{.kind = LaserKind::beam, .range_sigma = 0.01});
  mission.rig.thermal_camera = ThermalCamera{.camera = wideCamera(), .T_body_camera = lookingAhead()};
  mission.trajectory = Trajectory(std::move(poses));
  return mission;
}

/// Echoes of the wall near the laser's axis: `count` points from `stamp` on, a millisecond apart.
Reading readingAt(double stamp, int count = 1) {
  Reading reading{.stamp = at(stamp)};
  for (int i = 0; i < count; ++i) {
    reading.returns.push_back({at(stamp) + std::chrono::milliseconds(i), {kWall, 0.02 * i, 0.01 * i}});
  }
  return reading;
}

ThermalFrame frameAt(double stamp, double celsius) {
  const Camera camera = wideCamera();
  return test::frameOf(test::imageOf(camera.width(), camera.height(), [&](int, int) { return celsius; }),
                       at(stamp));
}

class Readings final : public ReadingSource {
 public:
  explicit Readings(std::vector<Reading> readings) : readings_(std::move(readings)) {}
  std::optional<Reading> next() override {
    if (next_ == readings_.size()) return std::nullopt;
    return readings_[next_++];
  }

 private:
  std::vector<Reading> readings_;
  std::size_t next_ = 0;
};

class Frames final : public FrameSource {
 public:
  explicit Frames(std::vector<ThermalFrame> frames) : frames_(std::move(frames)) {}
  std::optional<ThermalFrame> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    return frames_[next_++];
  }
  Duration period() const override { return durationFromSeconds(kPeriod); }

 private:
  std::vector<ThermalFrame> frames_;
  std::size_t next_ = 0;
};

/// What came out of mapping a mission.
struct Result {
  ThermalMap map{ThermalMap::Options{}};
  std::vector<ColouredReturn> points;
  MissionReport report;
};

Result mapAll(const Mission& mission, std::vector<Reading> readings, std::vector<ThermalFrame> frames,
              const MissionMapper::Options& options = {}) {
  Result result;
  Readings reading_source(std::move(readings));
  Frames frame_source(std::move(frames));
  result.report = mapMission(mission, reading_source, mission.rig.thermal_camera ? &frame_source : nullptr,
                             result.map, options, [&result](std::span<const ColouredReturn> reading) {
                               result.points.insert(result.points.end(), reading.begin(), reading.end());
                             });
  return result;
}

void expectAccountOfEveryPoint(const MissionReport& report) {
  const std::size_t uncoloured =
      std::accumulate(report.uncoloured.begin(), report.uncoloured.end(), std::size_t{0},
                      [](std::size_t sum, const auto& reason) { return sum + reason.second; });
  EXPECT_EQ(report.points, report.coloured + uncoloured);
}

TEST(MissionMapper, ReturnsThatTheTrajectoryDoesNotCoverAreDroppedAndCountedByReason) {
  std::vector<StampedPose> with_gap = poses(0.5, 0.0);
  std::erase_if(with_gap, [](const auto& p) { return p.stamp > at(14.0) && p.stamp < at(15.0); });
  const Mission mission = missionOf(std::move(with_gap));
  const Result result = mapAll(mission,
                               {readingAt(9.0, 3), readingAt(9.999, 2), readingAt(12.0, 5),
                                readingAt(14.5, 7), readingAt(17.0, 4), readingAt(20.5, 11)},
                               {});
  EXPECT_EQ(result.report.readings, 6U);
  EXPECT_EQ(result.report.points, 10U);  // that of 10.000 s too: the poses begin there
  EXPECT_EQ(result.points.size(), 10U);
  EXPECT_EQ(result.report.dropped,
            (std::map<std::string, std::size_t>{
                {"before_trajectory", 4}, {"trajectory_gap", 7}, {"after_trajectory", 11}}));
  EXPECT_EQ(result.report.first_stamp, at(10.0));
  EXPECT_EQ(result.report.last_stamp, at(17.003));
}

TEST(MissionMapper, WhatTheLaserItselfDroppedIsCountedBesideThePoints) {
  Reading reading = readingAt(12.0);
  reading.dropped = {.no_return = 2, .too_near = 3, .too_far = 5, .too_weak = 7};
  const Result result = mapAll(missionOf(poses(0.0, 0.0)), {reading, readingAt(13.0)}, {});
  EXPECT_EQ(result.report.points, 2U);
  EXPECT_EQ(result.report.dropped, (std::map<std::string, std::size_t>{
                                       {"no_return", 2}, {"too_near", 3}, {"too_far", 5}, {"too_weak", 7}}));
}

TEST(MissionMapper, ATrajectoryThatCoversNoneOfTheReadingsIsAnErrorNamingTheMission) {
  const Mission mission = missionOf(poses(0.0, 0.0));
  const std::string message = test::messageOf<DataError>([&] {
    (void)mapAll(mission, {readingAt(5.0, 3), readingAt(6.0, 3)}, {frameAt(5.0, 20.0)});
  });
  EXPECT_THAT(message, testing::HasSubstr("mission synthetic: its trajectory covers none of its 2 readings"));
  EXPECT_THAT(message, testing::HasSubstr("before_trajectory 6"));
}

TEST(MissionMapper, AMissionWithoutOneValidReturnDoesNotBlameItsTrajectory) {
  Reading reading{.stamp = at(12.0)};
  reading.dropped.too_far = 4;
  const Mission mission = missionOf(poses(0.0, 0.0));
  EXPECT_THAT(
      test::messageOf<DataError>([&] { (void)mapAll(mission, {reading}, {}); }),
      testing::AllOf(testing::HasSubstr("mission synthetic: none of its 1 readings has a valid return"),
                     testing::Not(testing::HasSubstr("trajectory"))));
}

TEST(MissionMapper, APointWithoutFrameStillMapsGeometry) {
  const Mission mission = missionOf(poses(0.0, 0.0));
  const Result result = mapAll(mission, {readingAt(11.0), readingAt(15.0)}, {frameAt(11.0, 40.0)});
  EXPECT_EQ(result.report.coloured, 1U);
  EXPECT_EQ(result.report.uncoloured, (std::map<std::string, std::size_t>{{"no_frame", 1}}));
  const SurfaceCell* cell = result.map.surface(result.map.keyOf({kWall, 0.0, 1.0}));
  ASSERT_NE(cell, nullptr);
  EXPECT_EQ(cell->returns, 2U);
  EXPECT_EQ(cell->observations, 1U);
  EXPECT_EQ(result.map.occupancy(result.map.keyOf({kWall - 1.0, 0.0, 1.0})), Occupancy::free);
}

TEST(MissionMapper, ARigWithoutThermalCameraMapsGeometryAndRefusesFrames) {
  Mission mission = missionOf(poses(0.0, 0.0));
  mission.rig.thermal_camera.reset();
  const Result result = mapAll(mission, {readingAt(11.0, 5)}, {});
  EXPECT_EQ(result.report.uncoloured, (std::map<std::string, std::size_t>{{"no_camera", 5}}));
  EXPECT_GT(result.map.surfaceCount(), 0U);
  ThermalMap map{ThermalMap::Options{}};
  MissionMapper mapper(mission, map, Duration::zero(), {});
  EXPECT_THROW(mapper.add(frameAt(11.0, 20.0)), ConfigError);
}

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
  EXPECT_EQ(result.report.uncoloured, (std::map<std::string, std::size_t>{{"no_frame", 1}}));
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

/// Readings and frames at stamps of which many are equal.
struct Stream {
  std::vector<Reading> readings;
  std::vector<ThermalFrame> frames;
};

Stream streamWithEqualStamps() {
  Stream stream;
  for (int i = 0; i < 300; ++i) stream.readings.push_back(readingAt(11.0 + 0.02 * i, 8));
  for (int i = 0; i < 30; ++i) stream.frames.push_back(frameAt(11.0 + kPeriod * i, 20.0 + i));
  return stream;
}

/// Feeds the stream by stamps; where a frame and a reading have the same, a coin says which goes first.
Result feedShuffled(const Mission& mission, const Stream& stream, unsigned seed) {
  std::mt19937 rng(seed);
  Result result;
  MissionMapper mapper(mission, result.map, durationFromSeconds(kPeriod), {},
                       [&result](std::span<const ColouredReturn> reading) {
                         result.points.insert(result.points.end(), reading.begin(), reading.end());
                       });
  std::size_t frame = 0, reading = 0;
  while (frame < stream.frames.size() || reading < stream.readings.size()) {
    const Time frame_stamp = frame < stream.frames.size() ? stream.frames[frame].stamp : Time::max();
    const Time reading_stamp =
        reading < stream.readings.size() ? stream.readings[reading].stamp : Time::max();
    const bool frame_first = frame_stamp == reading_stamp ? (rng() & 1U) != 0 : frame_stamp < reading_stamp;
    if (frame_first) {
      mapper.add(stream.frames[frame++]);
    } else {
      mapper.add(stream.readings[reading++]);
    }
  }
  result.report = mapper.finish();
  return result;
}

TEST(MissionMapper, TheResultDoesNotDependOnHowEqualStampsAreInterleaved) {
  const Mission mission = missionOf(poses(0.3, 0.2));
  const Stream stream = streamWithEqualStamps();
  const Result expected = mapAll(mission, stream.readings, stream.frames);
  ASSERT_GT(expected.report.coloured, 1000U);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Result other = feedShuffled(mission, stream, seed);
    EXPECT_TRUE(test::sameMap(expected.map, other.map));
    EXPECT_EQ(other.report.coloured, expected.report.coloured);
    EXPECT_EQ(other.report.uncoloured, expected.report.uncoloured);
    ASSERT_EQ(other.points.size(), expected.points.size());
    for (std::size_t i = 0; i < other.points.size(); ++i) {
      ASSERT_EQ(other.points[i].placed.stamp, expected.points[i].placed.stamp);
      ASSERT_EQ(other.points[i].colour.has_value(), expected.points[i].colour.has_value());
      if (!other.points[i].colour) continue;
      ASSERT_EQ(other.points[i].colour->celsius, expected.points[i].colour->celsius);
    }
  }
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
    frames.push_back(
        test::frameOf(test::imageOf(camera.width(), camera.height(), celsius), at(12.0 + kPeriod * i)));
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

TEST(MissionMapper, EveryPointIsColouredOrCountedWithItsReason) {
  const Mission mission = missionOf(poses(0.4, 0.5));
  std::vector<Reading> readings;
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> aside(-6.0, 6.0), ahead(1.0, 5.0);
  for (int i = 0; i < 700; ++i) {
    Reading reading{.stamp = at(9.5 + 0.015 * i)};
    for (int j = 0; j < 20; ++j) reading.returns.push_back({reading.stamp, {ahead(rng), aside(rng), 0.2}});
    readings.push_back(reading);
  }
  std::vector<ThermalFrame> frames;
  for (int i = 0; i < 40; ++i) frames.push_back(frameAt(11.0 + kPeriod * i, 20.0));
  const Result result = mapAll(mission, readings, frames);
  expectAccountOfEveryPoint(result.report);
  EXPECT_GT(result.report.uncoloured.at("hidden"), 0U);
  EXPECT_GT(result.report.uncoloured.at("outside_image"), 0U);
  EXPECT_GT(result.report.uncoloured.at("no_frame"), 0U);
  EXPECT_EQ(result.points.size(), result.report.points);
}

// What waits is what the mapper remembers: a reading leaves as soon as nothing that comes later can change
// it.
TEST(MissionMapper, AReadingWaitsExactlyLookaheadAndFrameLimit) {
  const Mission mission = missionOf(poses(0.1, 0.0));
  const MissionMapper::Options options{.frame_limit = durationFromSeconds(0.15),
                                       .lookahead = durationFromSeconds(0.3)};
  ThermalMap map{ThermalMap::Options{}};
  std::vector<Time> mapped;
  MissionMapper mapper(
      mission, map, durationFromSeconds(kPeriod), options,
      [&mapped](std::span<const ColouredReturn> reading) { mapped.push_back(reading.back().placed.stamp); });
  std::vector<Time> added;
  for (int i = 0; i < 900; ++i) {
    const double stamp = 10.5 + 0.01 * i;
    if (i % 20 == 0) mapper.add(frameAt(stamp, 20.0));
    Reading reading = readingAt(stamp, 5);
    const Time due_before = reading.stamp - options.frame_limit - options.lookahead;
    const Time last = reading.returns.back().stamp;
    mapper.add(std::move(reading));
    const auto due = std::count_if(added.begin(), added.end(), [&](Time t) { return t < due_before; });
    ASSERT_EQ(mapped.size(), static_cast<std::size_t>(due)) << "at " << stamp << " s";
    added.push_back(last);
  }
  EXPECT_GT(mapped.size(), 800U);
  (void)mapper.finish();
  EXPECT_EQ(mapped, added);
}

TEST(MissionMapper, RefusesOptionsThatMakeNoSense) {
  const Mission mission = missionOf(poses(0.0, 0.0));
  ThermalMap map{ThermalMap::Options{}};
  const auto refused = [&](const MissionMapper::Options& options) {
    return test::messageOf<ConfigError>(
        [&] { MissionMapper mapper(mission, map, Duration::zero(), options); });
  };
  EXPECT_THAT(refused({.frame_limit = Duration(-1)}), testing::HasSubstr("frame_limit"));
  EXPECT_THAT(refused({.lookahead = Duration(-1)}), testing::HasSubstr("lookahead"));
}

}  // namespace
}  // namespace thermovox
