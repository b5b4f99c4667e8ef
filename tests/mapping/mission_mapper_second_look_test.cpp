// Missions in two passes: what hides things then, and what is painted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "mapping/imported_geometry.hpp"
#include "mapping/mission_mapper.hpp"
#include "projection/error.hpp"
#include "tests/mapping/synthetic_mission.hpp"

namespace thermovox::test {
namespace {

using Pass = MissionMapper::Pass;

/// A still body: its laser in (0, 0, 1), looking along x.
Mission stillMission() {
  return missionOf(poses(0.0, 0.0));
}

Result mapTwice(const Mission& mission, const std::vector<Reading>& readings,
                const std::vector<ThermalFrame>& frames, Pass pass,
                const std::vector<const ThermalMap*>& known = {}) {
  Result result;
  Readings first(readings);
  (void)mapMission({mission, first, nullptr}, result.map, {});
  std::vector<const ThermalMap*> maps = known;
  maps.push_back(&result.map);
  SceneSurfaces scene(maps);
  Readings second(readings);
  Frames frame_source(frames);
  result.report = mapMission({mission, second, &frame_source}, result.map, {.pass = pass, .scene = &scene},
                             {.points = [&result](std::span<const ColouredReturn> reading) {
                               result.points.insert(result.points.end(), reading.begin(), reading.end());
                             }});
  return result;
}

/// 0.8 x 0.8 m across the laser's axis, 2.5 m ahead.
Reading plateAt(double stamp) {
  Reading reading{.stamp = at(stamp)};
  for (int i = -20; i < 20; ++i) {
    for (int j = -20; j < 20; ++j) reading.returns.push_back({at(stamp), {2.52, 0.02 * i, 0.02 * j}});
  }
  return reading;
}

std::size_t observationsAt(const ThermalMap& map, const Eigen::Vector3d& p_world) {
  const SurfaceCell* surface = map.surface(map.keyOf(p_world));
  return surface == nullptr ? 0 : static_cast<std::size_t>(surface->observations);
}

/// The same temperatures from the same ranges; the second look knows angles that the first did not.
void expectSameTemperatures(const ThermalMap& once, const ThermalMap& twice) {
  ASSERT_EQ(once.surfaceCount(), twice.surfaceCount());
  forEachSurface(once, [&](const CellKey& key, const SurfaceCell& cell) {
    const SurfaceCell* other = twice.surface(key);
    ASSERT_NE(other, nullptr);
    ASSERT_EQ(other->observations, cell.observations);
    EXPECT_EQ(other->meanOffset(), cell.meanOffset());
    EXPECT_EQ(twice.logOdds(key), once.logOdds(key));
    if (cell.observations == 0) return;
    EXPECT_EQ(other->bestView().range, cell.bestView().range);
    EXPECT_EQ(other->commonSigma(), 0.0);  // they look from ahead
    EXPECT_EQ(other->mean(), cell.mean());
    EXPECT_EQ(other->sigmaOfMean(), cell.sigmaOfMean());
  });
}

TEST(SecondLook, WhereNothingHidesTheMapIsThatOfOnePass) {
  const Mission mission = missionOf(poses(0.5, 0.1));
  std::vector<Reading> readings;
  std::vector<ThermalFrame> frames;
  for (int i = 0; i < 100; ++i) readings.push_back(readingAt(12.0 + 0.02 * i, 5));
  for (int i = 0; i < 10; ++i) frames.push_back(frameAt(12.0 + kPeriod * i, 100.0 + i));
  const Result once = mapAll(mission, readings, frames);
  const Result twice = mapTwice(mission, readings, frames, Pass::colours);
  EXPECT_GE(once.report.coloured, 490U);  // the last are too far in time from any frame
  EXPECT_EQ(twice.report.coloured, once.report.coloured);
  EXPECT_EQ(twice.report.points, 500U);
  EXPECT_EQ(twice.report.painted, 0U);
  expectSameTemperatures(once.map, twice.map);
}

TEST(SecondLook, HidesAPointBehindWhatTheLaserMeasuresOnlyLater) {
  const std::vector<Reading> readings{readingAt(12.0), plateAt(18.0)};
  const std::vector<ThermalFrame> frames{frameAt(12.0, 50.0)};
  EXPECT_EQ(mapAll(stillMission(), readings, frames).report.coloured, 1U);
  const Result twice = mapTwice(stillMission(), readings, frames, Pass::colours);
  EXPECT_EQ(twice.report.coloured, 0U);
  EXPECT_EQ(twice.report.uncoloured.at("hidden"), 1U);
  expectAccountOfEveryPoint(twice.report);
}

/// A wall whose normal is turned by 70 degrees from the camera's axis, 5 m ahead, beam by beam.
std::vector<Reading> grazedWall() {
  const double turned = 20.0 * std::numbers::pi / 180.0;
  std::vector<Reading> readings;
  for (int i = -25; i <= 25; ++i) {
    for (int j = -15; j <= 15; ++j) {
      const double stamp = 12.0 + 5e-5 * static_cast<double>(readings.size());
      const Eigen::Vector3d p_laser(5.0 + 0.02 * i * std::cos(turned), 0.02 * i * std::sin(turned), 0.02 * j);
      readings.push_back({.stamp = at(stamp), .returns = {{at(stamp), p_laser}}});
    }
  }
  return readings;
}

TEST(SecondLook, ABeamKnowsItsAnglesFromTheScene) {
  const std::vector<ThermalFrame> frames{frameAt(12.0, 60.0)};
  const Result once = mapAll(stillMission(), grazedWall(), frames);
  const Result twice = mapTwice(stillMission(), grazedWall(), frames, Pass::colours);
  const Eigen::Vector3d middle(5.0, 0.0, 1.0);
  const SurfaceCell* blind = once.map.surface(once.map.keyOf(middle));
  ASSERT_TRUE(blind != nullptr && blind->observations > 1);
  EXPECT_TRUE(std::isnan(blind->bestView().incidence));
  EXPECT_EQ(blind->commonSigma(), 0.0);
  const SurfaceCell* cell = twice.map.surface(twice.map.keyOf(middle));
  ASSERT_TRUE(cell != nullptr && cell->observations > 1);
  EXPECT_NEAR(cell->bestView().incidence, 70.0 * std::numbers::pi / 180.0, 0.05);
  // 12 % of 40 C, however many returns and however many of them one pixel coloured.
  EXPECT_NEAR(cell->commonSigma(), 4.8, 1.5);
  EXPECT_NEAR(cell->sigmaOfMean(), cell->commonSigma(), 0.5);
  EXPECT_TRUE(std::any_of(twice.points.begin(), twice.points.end(), [](const ColouredReturn& point) {
    return point.colour && point.colour->sigma > 3.5F && point.colour->sigma < 8.0F;
  }));
}

TEST(SecondLook, PaintsWhatTheLaserMeasuredAtAnyOtherTime) {
  const std::vector<ThermalFrame> frames{frameAt(12.0, 50.0), frameAt(12.2, 50.0), frameAt(21.0, 99.0)};
  const Result result = mapTwice(stillMission(), {plateAt(18.0)}, frames, Pass::paint);
  EXPECT_EQ(result.report.coloured, 0U);
  EXPECT_EQ(result.report.painted, result.map.surfaceCount());
  EXPECT_EQ(observationsAt(result.map, {2.52, 0.1, 1.1}), 2U);  // the third frame has no pose
  EXPECT_NEAR(result.map.surface(result.map.keyOf({2.52, 0.1, 1.1}))->mean(), 50.0, 0.01);
}

TEST(SecondLook, DoesNotCountALaserPointAndThePaintOfItsFrameTwice) {
  const Result result =
      mapTwice(stillMission(), {plateAt(12.0)}, {frameAt(12.0, 50.0), frameAt(12.1, 50.0)}, Pass::paint);
  EXPECT_EQ(result.report.coloured, 1600U);  // in the record of the points
  EXPECT_EQ(observationsAt(result.map, {2.52, 0.1, 1.1}), 2U);
}

TEST(SecondLook, PaintsTheSurfacesOfKnownMapsIntoTheMissionsOwn) {
  ThermalMap known{ThermalMap::Options{}};
  addGeometry(std::vector<Eigen::Vector3d>{{4.02, 1.01, 1.02}, {4.02, 0.01, 1.02}}, known);
  const Result result =
      mapTwice(stillMission(), {plateAt(12.0)}, {frameAt(12.0, 50.0)}, Pass::paint, {&known});
  EXPECT_EQ(observationsAt(result.map, {4.02, 1.01, 1.02}), 1U);
  EXPECT_EQ(observationsAt(result.map, {4.02, 0.01, 1.02}), 0U);  // behind the plate
}

TEST(SecondLook, ImportedGeometryHidesThingsInOnePassToo) {
  ThermalMap known{ThermalMap::Options{}};
  std::vector<Eigen::Vector3d> plate;
  for (const LaserReturn& ret : plateAt(0.0).returns)
    plate.emplace_back(ret.p_laser + Eigen::Vector3d(0, 0, 1));
  addGeometry(plate, known);
  SceneSurfaces scene({&known});
  const Result result = mapAll(stillMission(), {readingAt(12.0)}, {frameAt(12.0, 50.0)}, {.scene = &scene});
  EXPECT_EQ(result.report.uncoloured, (std::map<std::string, std::size_t>{{"hidden", 1}}));
}

TEST(SecondLook, NeedsAScene) {
  const MissionMapper::Options options{.pass = Pass::colours};
  EXPECT_THROW(options.validate(), ConfigError);
}

}  // namespace
}  // namespace thermovox::test
