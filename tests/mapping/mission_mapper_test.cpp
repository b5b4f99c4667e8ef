#include "mapping/mission_mapper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "projection/error.hpp"
#include "tests/mapping/synthetic_mission.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox::test {
namespace {

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
  const std::string message = messageOf<DataError>([&] {
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
      messageOf<DataError>([&] { (void)mapAll(mission, {reading}, {}); }),
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
  MissionMapper mapper(mission, map, {});
  EXPECT_THROW(mapper.add(frameAt(11.0, 20.0)), ConfigError);
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
  MissionMapper mapper(mission, result.map, {.frame_limit = kFrameLimit},
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
    EXPECT_TRUE(sameMap(expected.map, other.map));
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
  MissionMapper mapper(mission, map, options, [&mapped](std::span<const ColouredReturn> reading) {
    mapped.push_back(reading.back().placed.stamp);
  });
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

TEST(MissionMapper, ForgetsFramesThatNoReadingIsNear) {
  // A camera that records on while the laser pauses must not fill the memory.
  const Mission mission = missionOf(poses(0.0, 0.0));
  ThermalMap map{ThermalMap::Options{}};
  MissionMapper mapper(mission, map, {.frame_limit = kFrameLimit});
  mapper.add(readingAt(10.5));
  std::vector<std::weak_ptr<const ThermalImage>> images;
  for (int i = 0; i < 40; ++i) {
    ThermalFrame frame = frameAt(11.0 + kPeriod * i, 20.0);
    images.push_back(frame.image);
    mapper.add(std::move(frame));
  }
  const auto alive =
      std::count_if(images.begin(), images.end(), [](const auto& image) { return !image.expired(); });
  EXPECT_LE(static_cast<double>(alive), 2.0 + 0.5 / kPeriod) << "those within the lookahead";
  EXPECT_EQ(mapper.finish().points, 1U);
}

TEST(MissionMapper, TakesRepeatedSamplesOfOnePixelForOne) {
  // Fifty returns in one frame's one pixel share its noise: the cell must not claim to have averaged it away.
  const Mission mission = missionOf(poses(0.0, 0.0));
  std::vector<Reading> readings;
  for (int i = 0; i < 50; ++i) readings.push_back(readingAt(11.0 + 0.001 * i));
  const Result result = mapAll(mission, readings, {frameAt(11.0, 40.0)});
  const SurfaceCell* cell = result.map.surface(result.map.keyOf({kWall, 0.0, 1.0}));
  ASSERT_NE(cell, nullptr);
  EXPECT_EQ(cell->observations, 50U);
  EXPECT_GT(cell->sigmaOfMean(), 0.7 * result.points.front().colour->sigma);
}

TEST(MissionMapper, RefusesOptionsThatMakeNoSense) {
  const Mission mission = missionOf(poses(0.0, 0.0));
  ThermalMap map{ThermalMap::Options{}};
  const auto refused = [&](const MissionMapper::Options& options) {
    return messageOf<ConfigError>([&] { MissionMapper mapper(mission, map, options); });
  };
  EXPECT_THAT(refused({.frame_limit = Duration(-1)}), testing::HasSubstr("frame_limit"));
  EXPECT_THAT(refused({.lookahead = Duration(-1)}), testing::HasSubstr("lookahead"));
}

}  // namespace
}  // namespace thermovox::test
