// How near missions come to the truth that are mapped in two passes, and how near painted cells do.
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "mapping/imported_geometry.hpp"
#include "mapping/painting.hpp"
#include "mapping/surface_cloud.hpp"
#include "tests/apps/accuracy.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;

/// The surfaces of a mission, as a cloud that was exported and imported again.
ThermalMap importedFrom(const fs::path& mission) {
  ThermalMap map(ThermalMap::Options{});
  mapGeometry(mission, map);
  std::vector<Eigen::Vector3d> points;
  for (const SurfacePoint& point : surfaceCloud(map)) points.push_back(point.p_world.cast<double>());
  ThermalMap imported(ThermalMap::Options{});
  addGeometry(points, imported);
  return imported;
}

constexpr Look kTwoPasses{.pass = MissionMapper::Pass::colours};

/// What two passes have to reach, with the independent halls' clutter.
void expectPerfectInTwoPasses(const Accuracy& accuracy) {
  EXPECT_LE(accuracy.coloured.mae(), 0.08);
  EXPECT_LE(accuracy.coloured.rms(), 0.355);
  EXPECT_GE(accuracy.kept, 0.972);
  EXPECT_LE(accuracy.sure.rms(), 0.15);
  expectHonestSigmas(accuracy);
}

TEST(Accuracy, ScanInTwoPasses) {
  THERMOVOX_NEEDS_RECORDINGS();
  expectPerfectInTwoPasses(recordedAccuracy("hall-scan", kTwoPasses));
}

TEST(Accuracy, BeamInTwoPassesWithTheCloudsGeometry) {
  THERMOVOX_NEEDS_RECORDINGS();
  const ThermalMap known = importedFrom(*recordings() / "missions" / "hall-cloud");
  expectPerfectInTwoPasses(
      recordedAccuracy("hall-beam", {.pass = MissionMapper::Pass::colours, .known = &known}));
}

/// What the cells of a map are worth.
struct CellAccuracy {
  Errors coloured;
  std::size_t seen = 0;  ///< that some frame sees in truth
  double kept = 0.0;     ///< share of these that have a temperature
};

CellAccuracy cellAccuracy(const ThermalMap& map, const fs::path& mission, const Hall& hall) {
  const PerfectColouring perfect(mission, hall);
  CellAccuracy result;
  std::size_t kept = 0;
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    const Eigen::Vector3d p_world = surfacePoint(map, key, cell).p_world.cast<double>();
    if (cell.observations > 0) result.coloured.add(cell.mean() - hall.temperatureAt(p_world));
    if (!perfect.isSeen(p_world, paintRange(perfect.camera(), map.resolution()))) return;
    ++result.seen;
    kept += cell.observations > 0;
  });
  result.kept = static_cast<double>(kept) / static_cast<double>(result.seen);
  return result;
}

/// Of a recorded mission's map, merged with what else is known of the place.
CellAccuracy recordedCells(const std::string& name, const Look& look) {
  const fs::path mission = *recordings() / "missions" / name;
  Mapped all = mapped(mission, look);
  if (look.known != nullptr) all.map.merge(*look.known);
  const CellAccuracy a =
      cellAccuracy(all.map, mission, simulate::readTrueHall(mission.string() + ".truth.json"));
  std::printf("%s: %zu of %zu cells coloured, MAE %.3f rms %.3f C; seen in truth %zu, kept %.2f %%\n",
              name.c_str(), a.coloured.count(), all.map.surfaceCount(), a.coloured.mae(), a.coloured.rms(),
              a.seen, 100 * a.kept);
  return a;
}

TEST(Accuracy, PaintedCellsOfAScan) {
  THERMOVOX_NEEDS_RECORDINGS();
  using enum MissionMapper::Pass;
  const CellAccuracy plain = recordedCells("hall-scan", {});
  const CellAccuracy painted = recordedCells("hall-scan", {.pass = paint});
  EXPECT_GE(painted.kept, 0.95);  // of what the camera saw at all
  EXPECT_LE(painted.coloured.mae(), 0.2);
  const ThermalMap known = importedFrom(*recordings() / "missions" / "hall-cloud");
  const CellAccuracy all = recordedCells("hall-scan", {.pass = paint, .known = &known});
  EXPECT_GE(all.coloured.count(), 5 * plain.coloured.count());
  EXPECT_LE(all.coloured.mae(), 0.2);
}

TEST(Accuracy, PaintedCellsOfABeam) {
  THERMOVOX_NEEDS_RECORDINGS();
  const ThermalMap known = importedFrom(*recordings() / "missions" / "hall-cloud");
  const CellAccuracy painted =
      recordedCells("hall-beam", {.pass = MissionMapper::Pass::paint, .known = &known});
  EXPECT_GE(painted.coloured.count(), 50000U);
  EXPECT_GE(painted.kept, 0.95);
  EXPECT_LE(painted.coloured.mae(), 0.2);
}

/// With all geometry known a colouring is as good as the perfect one.
void expectAsGoodAsPerfect(const Accuracy& accuracy) {
  EXPECT_LE(accuracy.coloured.mae(), accuracy.perfect.mae());
  EXPECT_LE(accuracy.coloured.rms(), accuracy.perfect.rms());
  EXPECT_GE(accuracy.kept, 0.965);
  EXPECT_LE(accuracy.sure.rms(), 0.15);
  expectHonestSigmas(accuracy);
}

TEST(Accuracy, ScansOfOtherHallsInTwoPasses) {
  using enum LensModel;
  expectAsGoodAsPerfect(flownAccuracy("two passes 31", LaserKind::scan, 31, brown_conrady, kTwoPasses));
  expectAsGoodAsPerfect(flownAccuracy("two passes 23 wide", LaserKind::scan, 23, kannala_brandt, kTwoPasses));
}

}  // namespace
}  // namespace thermovox::test
