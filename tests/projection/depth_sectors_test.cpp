// Visibility by the laser's own points, on scenes whose truth is known. The bounds are set with a reserve
// over what the default options reach, and far under what a one-pixel z-buffer misses.
#include "projection/depth_sectors.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

#include "projection/error.hpp"
#include "tests/projection/random_cameras.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

const Camera kCamera(test::intrinsicsOf(LensModel::pinhole, {}, 320, 256));

Sight sightOf(const Eigen::Vector3d& p_camera, const Pose& T_camera_world = {}) {
  const Pose T_world_camera = T_camera_world.inverse();
  return {T_world_camera.translation, T_world_camera * p_camera, kCamera.project(p_camera).value(),
          p_camera.z()};
}

DepthSectors sectorsOf(const std::vector<Eigen::Vector3d>& points, const Pose& T_camera_world = {}) {
  DepthSectors sectors(kCamera, T_camera_world, {});
  sectors.add(points);
  sectors.finish();
  return sectors;
}

/// Random directions over the whole image and a little beyond, `per_px` a pixel: p_camera at depth 1.
std::vector<Eigen::Vector3d> randomRays(double per_px, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  constexpr double kRim = 20.0;
  std::uniform_real_distribution<double> u(-kRim, kCamera.width() + kRim), v(-kRim, kCamera.height() + kRim);
  const auto count =
      static_cast<std::size_t>(per_px * (kCamera.width() + 2 * kRim) * (kCamera.height() + 2 * kRim));
  std::vector<Eigen::Vector3d> rays;
  while (rays.size() < count) rays.push_back(kCamera.rayFromPixel({u(random), v(random)}).value());
  return rays;
}

std::vector<Eigen::Vector3d> inImage(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> inside;
  std::copy_if(points.begin(), points.end(), std::back_inserter(inside),
               [](const Eigen::Vector3d& p) { return kCamera.project(p).has_value(); });
  return inside;
}

/// A plate of 1.6 x 1.2 m at 4 m before a wall at 10 m.
struct PlateBeforeWall {
  static constexpr double kPlate = 4.0, kWall = 10.0;
  static bool onPlate(const Eigen::Vector3d& ray) {
    return std::abs(ray.x() * kPlate) < 0.8 && std::abs(ray.y() * kPlate) < 0.6;
  }
  std::vector<Eigen::Vector3d> measured;  ///< what stands before the sectors
  std::vector<Eigen::Vector3d> hidden, visible;

  /// The laser measures from `laser` (camera frame), so that it sees wall that the camera does not.
  PlateBeforeWall(double per_px, const Eigen::Vector3d& laser, std::uint64_t seed) {
    for (const Eigen::Vector3d& ray : randomRays(per_px, seed)) {
      const Eigen::Vector3d on_plate = laser + ray * (kPlate - laser.z());
      if (onPlate(on_plate / kPlate)) {
        sort(on_plate);
      } else {
        sort(laser + ray * (kWall - laser.z()));
      }
    }
  }

 private:
  void sort(const Eigen::Vector3d& p) {
    measured.push_back(p);
    if (!kCamera.project(p)) return;
    const bool behind = p.z() > kPlate + 1.0 && onPlate(p / p.z());
    (behind ? hidden : visible).push_back(p);
  }
};

double shareHidden(const DepthSectors& sectors, const std::vector<Eigen::Vector3d>& points) {
  std::size_t hidden = 0;
  for (const Eigen::Vector3d& p : points) hidden += sectors.hides(sightOf(p)) ? 1 : 0;
  return static_cast<double>(hidden) / static_cast<double>(points.size());
}

class SparsePoints : public testing::TestWithParam<double> {};

TEST_P(SparsePoints, HideTheWallInThePlatesShadowAndKeepTheRest) {
  // The laser beside the camera sees a strip of wall, some 7 px wide, past the plate's edge.
  const PlateBeforeWall scene(GetParam(), {0.15, 0.0, 0.0}, 21);
  ASSERT_GT(scene.hidden.size(), 20U);
  const DepthSectors sectors = sectorsOf(scene.measured);
  const double found = shareHidden(sectors, scene.hidden);
  const double lost = shareHidden(sectors, scene.visible);
  EXPECT_GT(found, 0.9);
  EXPECT_LT(lost, 0.025);
}

TEST_P(SparsePoints, HideWhatOtherViewsSawFarBehindThePlate) {
  const PlateBeforeWall scene(GetParam(), Eigen::Vector3d::Zero(), 22);
  std::vector<Eigen::Vector3d> wall;
  for (const Eigen::Vector3d& ray : randomRays(0.1, 23)) {
    if (PlateBeforeWall::onPlate(ray) && kCamera.project(ray)) wall.push_back(ray * PlateBeforeWall::kWall);
  }
  const double found = shareHidden(sectorsOf(scene.measured), wall);
  EXPECT_GT(found, 0.9);
}

INSTANTIATE_TEST_SUITE_P(DepthSectors, SparsePoints, testing::Values(0.05, 0.1, 0.2, 0.5, 1.0));

/// A floor `height` metres under the camera, which looks `pitch` radians below the horizon.
std::vector<Eigen::Vector3d> floorUnder(double height, double pitch) {
  const Eigen::Vector3d down(0.0, std::cos(pitch), std::sin(pitch));
  std::vector<Eigen::Vector3d> floor;
  for (const Eigen::Vector3d& ray : randomRays(0.3, 24)) {
    if (down.dot(ray) > 0.02) floor.push_back(ray * height / down.dot(ray));
  }
  return floor;
}

TEST(DepthSectors, LetASlantedFloorBeSeen) {
  // It recedes by cos(pitch) / (y cos(pitch) + sin(pitch)) metres a metre aside: 1.8 at most in these views.
  for (const double pitch_deg : {45.0, 60.0, 80.0}) {
    for (const double height : {0.5, 1.5, 4.0}) {
      const std::vector<Eigen::Vector3d> floor = floorUnder(height, pitch_deg * M_PI / 180.0);
      EXPECT_EQ(shareHidden(sectorsOf(floor), inImage(floor)), 0.0)
          << height << " m, " << pitch_deg << " deg";
    }
  }
}

/// A plane 5 m ahead that recedes by `slope` metres a metre aside in the image's middle, towards `heading`,
/// and by ever more further on; cut off where that is more than `steepest`.
std::vector<Eigen::Vector3d> tiltedPlane(double slope, double heading, double steepest) {
  const Eigen::Vector2d uphill(std::cos(heading), std::sin(heading));
  std::vector<Eigen::Vector3d> plane;
  for (const Eigen::Vector3d& ray : randomRays(1.0, 32)) {
    const double left = 1.0 - slope * uphill.dot(ray.head<2>());
    if (left > 0.0 && slope / left <= steepest) plane.push_back(ray * 5.0 / left);
  }
  return plane;
}

TEST(DepthSectors, LetTiltedPlanesBeSeenNearlyUpToTheSlopeOfTheOptions) {
  const double steepest = 3.5;
  ASSERT_LT(steepest, DepthSectors::Options{}.slope);
  for (const double slope : {0.5, 1.0, 2.0, 3.0, 3.4}) {
    for (int turn = 0; turn < 12; ++turn) {
      const std::vector<Eigen::Vector3d> plane = tiltedPlane(slope, 2.0 * M_PI * turn / 12 + 0.1, steepest);
      EXPECT_EQ(shareHidden(sectorsOf(plane), inImage(plane)), 0.0) << "slope " << slope << ", turn " << turn;
    }
  }
}

TEST(DepthSectors, LoseAGrazingFloorOnlyInPart) {
  // Seen along the horizon a floor recedes by 3 to 50 metres a metre aside, beyond the slope of the options:
  // there the nearer half of the neighbourhood looks like something that stands in front.
  for (const double height : {0.5, 1.5, 4.0}) {
    const std::vector<Eigen::Vector3d> floor = floorUnder(height, 0.0);
    EXPECT_LT(shareHidden(sectorsOf(floor), inImage(floor)), 0.15) << height << " m";
  }
}

TEST(DepthSectors, LetTheInsideOfACornerBeSeen) {
  // Three walls that meet at 6 m straight ahead, each leaning 55 degrees off the optical axis: the steepest
  // corner of a room, looked at along its diagonal.
  const Eigen::Vector3d corner(0.0, 0.0, 6.0);
  std::vector<Eigen::Vector3d> walls;
  for (const Eigen::Vector3d& ray : randomRays(0.3, 25)) {
    double depth = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const double angle = 2.0 * M_PI * i / 3.0 + 0.4;
      const Eigen::Vector3d normal(std::cos(angle) * std::sqrt(2.0 / 3.0),
                                   std::sin(angle) * std::sqrt(2.0 / 3.0), std::sqrt(1.0 / 3.0));
      if (normal.dot(ray) > 0.0) depth = std::min(depth, normal.dot(corner) / normal.dot(ray));
    }
    walls.push_back(ray * depth);
  }
  const DepthSectors sectors = sectorsOf(walls);
  EXPECT_EQ(shareHidden(sectors, inImage(walls)), 0.0);
}

TEST(DepthSectors, LetAFlatWallBeSeenThroughItsOwnNoise) {
  std::mt19937_64 random(26);
  std::normal_distribution<double> range_noise(0.0, 0.01);
  std::vector<Eigen::Vector3d> wall;
  for (const Eigen::Vector3d& ray : randomRays(0.5, 27)) {
    wall.push_back(ray * 6.0 + range_noise(random) * ray.normalized());
  }
  EXPECT_LT(shareHidden(sectorsOf(wall), inImage(wall)), 1e-3);
}

TEST(DepthSectors, DependOnWhereTheCameraStandsOnly) {
  const Pose T_camera_world{expRotation({0.4, -0.8, 0.3}), {5.0, -2.0, 7.0}};
  const PlateBeforeWall scene(0.2, {0.15, 0.0, 0.0}, 28);
  std::vector<Eigen::Vector3d> in_world;
  for (const Eigen::Vector3d& p : scene.measured) in_world.push_back(T_camera_world.inverse() * p);
  const DepthSectors here = sectorsOf(scene.measured);
  const DepthSectors there = sectorsOf(in_world, T_camera_world);
  std::size_t different = 0;
  for (const Eigen::Vector3d& p : scene.hidden) {
    different += here.hides(sightOf(p)) != there.hides(sightOf(p, T_camera_world)) ? 1 : 0;
  }
  EXPECT_LE(different, scene.hidden.size() / 100);  // a point on a bin's border may round to either side
}

TEST(DepthSectors, OfNoPointsHideNothing) {
  const DepthSectors sectors = sectorsOf({});
  for (const Eigen::Vector3d& ray : inImage(randomRays(0.05, 29))) {
    EXPECT_FALSE(sectors.hides(sightOf(ray * 1000.0)));
  }
  EXPECT_EQ(sectors.hiddenBeyond({10.0, 10.0}), std::numeric_limits<float>::infinity());
}

TEST(DepthSectors, OfOnePointHideNothing) {
  const DepthSectors sectors = sectorsOf({{0.0, 0.0, 2.0}});
  EXPECT_FALSE(sectors.hides(sightOf({0.0, 0.0, 10.0})));
}

TEST(DepthSectors, IgnorePointsThatTheCameraCannotSee) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& ray : randomRays(1.0, 30)) points.push_back(ray * -2.0);  // behind
  points.insert(points.end(), {{100, 0, 1}, {1e12, 1e12, 1}, {nan, 0, 1}, {0, 0, nan}, {0, 0, 0}});
  const DepthSectors sectors = sectorsOf(points);
  for (const Eigen::Vector3d& ray : inImage(randomRays(0.05, 31))) {
    EXPECT_FALSE(sectors.hides(sightOf(ray * 50.0)));
  }
}

/// The definition, bin by bin and neighbour by neighbour, for bins of one pixel.
float hiddenBeyondByDefinition(const std::vector<Eigen::Vector3d>& points,
                               const DepthSectors::Options& options, int column, int row) {
  constexpr float kNothing = std::numeric_limits<float>::infinity();
  const double focal_px = std::min(kCamera.fx(), kCamera.fy());
  std::vector<std::array<float, 8>> rings(static_cast<std::size_t>(options.radius_bins));
  for (auto& ring : rings) ring.fill(kNothing);
  for (const Eigen::Vector3d& p : points) {
    const auto pixel = kCamera.projectUnbounded(p);
    if (!pixel) continue;
    const double du = std::floor(pixel->x() + 0.5) - column;
    const double dv = std::floor(pixel->y() + 0.5) - row;
    const double distance = std::hypot(du, dv);
    const auto ring = static_cast<std::size_t>(std::round(distance));
    if (distance > 2.0 * options.radius_bins || ring < 1 || ring > rings.size()) continue;
    const double turn = std::atan2(dv, du) / (2.0 * M_PI) * 8.0 + 0.5;
    const auto sector = static_cast<std::size_t>((static_cast<int>(std::floor(turn)) + 8) % 8);
    const double scale = 1.0 / std::max(0.05, 1.0 - options.slope * distance / focal_px);
    float& nearest = rings[ring - 1][sector];
    nearest = std::min(nearest, static_cast<float>(p.z()) * static_cast<float>(scale));
  }
  std::array<float, 8> sectors;
  sectors.fill(kNothing);
  int more_bins = options.more_bins;
  for (const auto& ring : rings) {
    for (std::size_t s = 0; s < 8; ++s) sectors[s] = std::min(sectors[s], ring[s]);
    const bool answered = *std::max_element(sectors.begin(), sectors.end()) < kNothing;
    if (answered && more_bins-- == 0) break;
  }
  float hidden_beyond = kNothing;
  for (std::size_t i = 0; i < 4; ++i)
    hidden_beyond = std::min(hidden_beyond, std::max(sectors[i], sectors[i + 4]));
  return hidden_beyond + static_cast<float>(options.margin);
}

TEST(DepthSectors, SayAtEveryLevelToTheBitWhatTheirDefinitionSays) {
  const PlateBeforeWall scene(0.2, {0.15, 0.0, 0.0}, 33);
  std::mt19937_64 random(34);
  std::uniform_int_distribution<int> column(0, kCamera.width() - 1), row(0, kCamera.height() - 1);
  for (const int more_bins : {0, 1, 2}) {
    const DepthSectors::Options options{.bin_px = 1.0, .radius_bins = 5, .more_bins = more_bins};
    std::vector<DepthSectors> of_levels;
    for (const CpuLevel level : {CpuLevel::baseline, CpuLevel::avx2, CpuLevel::avx512}) {
      if (level > cpuLevel()) continue;
      of_levels.emplace_back(kCamera, Pose(), options, level);
      of_levels.back().add(scene.measured);
      of_levels.back().finish();
    }
    for (int i = 0; i < 300; ++i) {
      const int u = i < 20 ? 0 : column(random);  // the border, too
      const int v = i < 10 ? kCamera.height() - 1 : row(random);
      const float expected = hiddenBeyondByDefinition(scene.measured, options, u, v);
      for (const DepthSectors& sectors : of_levels)
        EXPECT_EQ(sectors.hiddenBeyond(Eigen::Vector2d(u, v)), expected) << u << ", " << v;
    }
  }
}

TEST(DepthSectors, RefuseOptionsThatCannotBe) {
  const auto refusal = [](DepthSectors::Options options) {
    return test::messageOf<ConfigError>([&] { options.validate(); });
  };
  EXPECT_NO_THROW(DepthSectors::Options{}.validate());
  EXPECT_THAT(refusal({.bin_px = -1.0}), testing::HasSubstr("bin_px"));
  EXPECT_THAT(refusal({.radius_bins = 0}), testing::HasSubstr("radius_bins"));
  EXPECT_THAT(refusal({.radius_bins = 1000}), testing::HasSubstr("radius_bins"));
  EXPECT_THAT(refusal({.more_bins = -1}), testing::HasSubstr("more_bins"));
  EXPECT_THAT(refusal({.slope = -1.0}), testing::HasSubstr("slope"));
  EXPECT_THAT(refusal({.margin = std::numeric_limits<double>::quiet_NaN()}), testing::HasSubstr("margin"));
}

}  // namespace
}  // namespace thermovox
