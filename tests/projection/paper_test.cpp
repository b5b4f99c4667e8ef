// The paper's worked numbers and its relations as special cases of the library. Its equation 1 is the pinhole
// back-projection with the laser's distance; 3 and 5 to 10 carry a 2D or 3D laser's points into the camera.
// Where only the relation is known and not the paper's own figures, the test says which relation it is and
// takes figures of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "projection/colouring.hpp"
#include "projection/laser/multi_beam.hpp"
#include "projection/laser/planar_scanner.hpp"
#include "projection/laser/range_finder.hpp"
#include "projection/radiometry.hpp"
#include "tests/projection/matchers.hpp"
#include "tests/projection/scene.hpp"

namespace thermovox {
namespace {

using test::IsNear;

constexpr Time kStamp{std::chrono::seconds(1'700'000'000)};

/// A camera like the paper's Duo R: 160 x 120 pixels over 57 by 44 degrees. K is our own choice.
Intrinsics duoR() {
  Intrinsics in{.width_px = 160, .height_px = 120, .model = LensModel::pinhole};
  in.parameters[kFx] = 147.3;
  in.parameters[kFy] = 148.5;
  in.parameters[kCx] = 79.5;
  in.parameters[kCy] = 59.5;
  return in;
}

/// Equation 1, written down once more: X = (u - cx) d / fx, Y = (v - cy) d / fy, Z = d.
Eigen::Vector3d equation1(const Intrinsics& in, const Eigen::Vector2d& pixel, double d) {
  return {(pixel.x() - in.parameters[kCx]) * d / in.parameters[kFx],
          (pixel.y() - in.parameters[kCy]) * d / in.parameters[kFy], d};
}

constexpr double kDecimalMm = 0.005;  // half of the last decimal that the paper gives

TEST(PaperEquation1, GivesFigure4) {
  const Camera camera(duoR());
  const Eigen::Vector2d pixel(66.18284, 82.31044);  // of figure 4's point, with this K
  const Eigen::Vector3d p_mm = camera.rayFromPixel(pixel).value() * 710.0;
  EXPECT_NEAR(p_mm.x(), -64.19, kDecimalMm);
  EXPECT_NEAR(p_mm.y(), 109.06, kDecimalMm);
  EXPECT_NEAR(p_mm.z(), 710.00, kDecimalMm);
  EXPECT_THAT(equation1(camera.intrinsics(), pixel, 710.0), IsNear(p_mm, 1e-9));
  EXPECT_THAT(camera.project({-0.06419, 0.10906, 0.71}).value(), IsNear(pixel, 1e-4));
}

TEST(PaperEquation1, CorrectsTable2) {
  const Camera camera(duoR());
  const Eigen::Vector2d pixel(80.04828, 53.15213);  // of the corrected point, with this K
  const Eigen::Vector3d ray = camera.rayFromPixel(pixel).value();
  const Eigen::Vector3d p_mm = ray * 4083.6;
  EXPECT_NEAR(p_mm.x(), 15.20, kDecimalMm);
  EXPECT_NEAR(p_mm.y(), -174.56, kDecimalMm);
  EXPECT_NEAR(p_mm.z(), 4083.6, kDecimalMm);
  EXPECT_THAT(equation1(camera.intrinsics(), pixel, 4083.6), IsNear(p_mm, 1e-9));
  // One pixel keeps X / d and Y / d: at half the distance half of both. The table's own X and Y stay
  // at 15.167 and -174.218 mm, which is off the pixel's ray by more than its last decimal.
  EXPECT_NEAR((ray * 2041.8).x(), 7.60, kDecimalMm);
  EXPECT_NEAR((ray * 2041.8).y(), -87.28, kDecimalMm);
  EXPECT_GT((p_mm - Eigen::Vector3d(15.167, -174.218, 4083.6)).norm(), 0.3);
}

TEST(PaperRadiometry, Reads44Point15DegreesFrom31730Counts) {
  EXPECT_NEAR(TLinear{}.celsius(31730), 44.15, 1e-5);
  EXPECT_NEAR(TLinear{}.celsius(27315), 0.0, 1e-5);
  EXPECT_TRUE(std::isnan(TLinear{}.celsius(0)));  // an empty pixel is no surface at absolute zero
  EXPECT_NEAR((TLinear{.celsius_per_count = 0.04, .celsius_offset = -273.15}.celsius(7500)), 26.85, 1e-4);
}

/// A rig that stands still: world, body and camera are one frame (z forward), and the laser is mounted in it.
struct StandingRig {
  ThermalCamera camera{.camera = Camera(duoR())};
  Laser laser{
      .T_body_laser = {Eigen::Quaterniond((Eigen::Matrix3d() << 0, -1, 0, 0, 0, -1, 1, 0, 0).finished()),
                       {0.02, -0.05, -0.01}}};  // laser x forward, y left, z up; camera x right, y down
  Mission mission{.trajectory = Trajectory({{kStamp, {}}, {kStamp + std::chrono::seconds(1), {}}})};
  ThermalView view{
      test::frameOf(test::imageOf(160, 120, [](int u, int v) { return 20.0 + 0.1 * u + 0.2 * v; }), kStamp),
      {},
      camera};

  struct Result {
    PlacedReturn placed;
    Colour colour;
  };
  Result resultOf(const LaserReturn& echo) const {
    const PlacedReturn placed = std::get<PlacedReturn>(place(echo, laser, mission));
    return {placed, std::get<Colour>(colour(placed, view, camera, NoOccluder()))};
  }
  /// The relations of equations 5, 6 and 8 to 10: p_camera = R p_laser + t, the pixel is K p_camera divided
  /// by its third component, and D = sqrt(x^2 + y^2 + z^2) is the distance in the laser's frame.
  void expectPapersRelations(const Eigen::Vector3d& p_laser, const Result& result) const {
    const Eigen::Vector3d p_camera = laser.T_body_laser.matrix() * p_laser + laser.T_body_laser.translation;
    const auto& p = camera.camera.intrinsics().parameters;
    const Eigen::Matrix3d K = (Eigen::Matrix3d() << p[kFx], 0, p[kCx], 0, p[kFy], p[kCy], 0, 0, 1).finished();
    const Eigen::Vector2d pixel = (K * p_camera).hnormalized();
    EXPECT_THAT(result.placed.p_world, IsNear(p_camera, 1e-12));
    EXPECT_THAT(result.colour.pixel, IsNear(pixel, 1e-9));
    EXPECT_NEAR(result.colour.celsius, 20.0 + 0.1 * pixel.x() + 0.2 * pixel.y(), 1e-4);
    EXPECT_NEAR(result.placed.range,
                std::sqrt(p_laser.x() * p_laser.x() + p_laser.y() * p_laser.y() + p_laser.z() * p_laser.z()),
                1e-12);
  }
};

TEST(PaperEquation3, CarriesAPointFromTheLaserIntoTheCamera) {
  // p_camera = R p_laser + t, by hand: 2 m at 30 degrees to the left are (1.73205, 1, 0) in the laser; the
  // camera has x to the right, y down, z forward, and the laser 20 mm right of, 50 above and 10 behind it.
  StandingRig rig;
  rig.laser.kind = LaserKind::scan;
  rig.laser.angle_min = M_PI / 6.0;
  rig.laser.angle_increment = 0.1;
  const std::vector<float> ranges{2.0F};
  const Reading reading = readingFromScan(kStamp, ranges, rig.laser);
  ASSERT_EQ(reading.returns.size(), 1U);
  const auto placed = std::get<PlacedReturn>(place(reading.returns[0], rig.laser, rig.mission));
  EXPECT_THAT(placed.p_world, IsNear(Eigen::Vector3d(-0.98, -0.05, 1.7220508), 1e-7));
  EXPECT_THAT(placed.origin_world, IsNear(Eigen::Vector3d(0.02, -0.05, -0.01), 1e-12));
}

TEST(PaperBeam, IsAPointAtItsDistanceAlongTheLasersAxis) {
  const StandingRig rig;
  const Reading reading = readingFromBeam({.stamp = kStamp, .range = 4.0836}, rig.laser);
  ASSERT_EQ(reading.returns.size(), 1U);
  const auto result = rig.resultOf(reading.returns[0]);
  EXPECT_DOUBLE_EQ(result.placed.range, 4.0836);
  rig.expectPapersRelations({4.0836, 0.0, 0.0}, result);
}

TEST(PaperBeam, ThroughTheCamerasCentreIsEquation1) {
  // With the laser in the camera's centre and looking along the ray of a pixel the point is equation 1's.
  StandingRig rig;
  const Eigen::Vector2d pixel(66.2, 82.3);
  const Eigen::Vector3d p_camera = equation1(rig.camera.camera.intrinsics(), pixel, 0.710);
  rig.laser.T_body_laser = {Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), p_camera),
                            {0, 0, 0}};
  const auto result =
      rig.resultOf(readingFromBeam({.stamp = kStamp, .range = p_camera.norm()}, rig.laser).returns.at(0));
  EXPECT_THAT(result.placed.p_world, IsNear(p_camera, 1e-12));
  EXPECT_THAT(result.colour.pixel, IsNear(pixel, 1e-9));
}

TEST(PaperScan, IsRangeTimesCosineAndSine) {  // x = r cos(a), y = r sin(a), then the camera
  StandingRig rig;
  rig.laser.kind = LaserKind::scan;
  rig.laser.angle_min = -0.4;
  rig.laser.angle_increment = 0.1;
  const std::vector<float> ranges{2.0F, 2.5F, 3.0F, 3.5F, 4.0F, 4.5F, 5.0F, 5.5F, 6.0F};
  const Reading reading = readingFromScan(kStamp, ranges, rig.laser);
  ASSERT_EQ(reading.returns.size(), ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double a = -0.4 + 0.1 * static_cast<double>(i);
    const Eigen::Vector3d p_laser(ranges[i] * std::cos(a), ranges[i] * std::sin(a), 0.0);
    rig.expectPapersRelations(p_laser, rig.resultOf(reading.returns[i]));
  }
}

TEST(PaperCloud, KeepsTheLasersOwnDistance) {
  StandingRig rig;
  rig.laser.kind = LaserKind::cloud;
  const std::vector<CloudPoint> points{{{3, 0.5F, 0.25F}}, {{6, -1.5F, 1}}, {{2, 0.25F, -0.5F}}};
  const Reading reading = readingFromCloud(kStamp, points, rig.laser);
  ASSERT_EQ(reading.returns.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    rig.expectPapersRelations(points[i].p_laser.cast<double>(), rig.resultOf(reading.returns[i]));
  }
}

}  // namespace
}  // namespace thermovox
