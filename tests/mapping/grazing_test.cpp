#include "mapping/grazing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "projection/grazing_emissivity.hpp"
#include "tests/mapping/synthetic_scene.hpp"
#include "tests/projection/scene.hpp"
#include "tests/support/radiometry.hpp"

namespace thermovox::test {
namespace {

constexpr double kEdge = 0.4;
constexpr double kNoise = 0.01;
const Colour kSeen{.pixel = Eigen::Vector2d::Zero(), .celsius = 60.0F, .sigma = 0.05F};

ThermalView viewOf(const ThermalImage& image) {
  return {frameOf(image), Pose{}, {.camera = sceneCamera()}};
}
ThermalImage plainImage() {
  return imageOf(160, 120, [](int, int) { return 60.0; });
}

/// The laser need not stand where the camera stands: here it sees every wall from its front.
const Eigen::Vector3d kFromLaser(0.0, 0.0, -5.0);

/// A reading of a wall 5 m ahead of the camera whose normal is turned by `angle` from the line of sight.
struct Wall {
  std::vector<PlacedReturn> returns;
  std::vector<std::optional<FrameColour>> found;

  Wall(double angle_deg, const ThermalView& view, int rows = 40) {
    std::mt19937_64 random(8);
    std::normal_distribution<double> noise(0.0, kNoise / 2.0);
    const Eigen::AngleAxisd turn(angle_deg * std::numbers::pi / 180.0, Eigen::Vector3d::UnitX());
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < 40; ++column) {
        const Eigen::Vector3d in_plane(0.03 * (column - 20), 0.03 * (row - rows / 2), noise(random));
        const Eigen::Vector3d p_world = Eigen::Vector3d(0, 0, 5) + turn * in_plane;
        returns.push_back({.p_world = p_world, .origin_world = p_world + turn * kFromLaser});
        found.push_back(FrameColour{.colour = kSeen, .view = &view});
      }
    }
  }
  [[nodiscard]] std::vector<GrazingView> views() const {
    return grazingViews(returns, found, readingNormals(returns, found, kEdge, kNoise), 15.0);
  }
  /// Of the middle of the wall.
  [[nodiscard]] std::size_t middle() const { return returns.size() / 2 + 20; }
};

TEST(Grazing, DistrustsWhatIsSeenAtAGrazingAngle) {
  const ThermalView view = viewOf(plainImage());
  for (const double angle : {0.0, 30.0, 65.0, 75.0}) {
    const Wall wall(angle, view);
    const GrazingView grazing = wall.views()[wall.middle()];
    const double radians = angle * std::numbers::pi / 180.0;
    EXPECT_NEAR(grazing.incidence, radians, 0.06) << angle;
    const double loss = emissivityLoss(static_cast<float>(std::cos(grazing.incidence)));
    EXPECT_NEAR(grazing.sigma, loss * 45.0, 1e-3) << angle;
    EXPECT_NEAR(distrusted(kSeen, grazing).sigma, std::hypot(0.05, loss * 45.0), 1e-3) << angle;
    if (angle < 40.0) {
      EXPECT_EQ(grazing.sigma, 0.0F);
    }
    if (angle > 60.0) {
      EXPECT_GT(grazing.sigma, 1.0F);
    }
  }
}

TEST(Grazing, AddsNothingWhereNoNormalIsKnown) {
  const ThermalView view = viewOf(plainImage());
  const Wall line(75.0, view, 1);  // one line of a scanner is no plane
  for (const GrazingView& grazing : line.views()) {
    EXPECT_TRUE(std::isnan(grazing.incidence));
    EXPECT_EQ(distrusted(kSeen, grazing).sigma, 0.05F);
  }
}

TEST(Grazing, TakesNoScanPlaneForASurface) {
  // A scanner's line over a corner of two walls: flat, wide, and in the plane of the scan.
  const ThermalView view = viewOf(plainImage());
  Wall corner(0.0, view, 1);
  for (std::size_t i = 0; i < corner.returns.size(); ++i) {
    const double along = 0.02 * static_cast<double>(i);
    corner.returns[i] = {
        .p_world = i < 20 ? Eigen::Vector3d(along, 0.1, 5.0) : Eigen::Vector3d(0.39, 0.1, 5.0 + along - 0.4),
        .origin_world = Eigen::Vector3d(-1.0, 0.1, 0.0)};
  }
  for (const GrazingView& grazing : corner.views()) EXPECT_TRUE(std::isnan(grazing.incidence));
}

TEST(Grazing, LeavesReturnsWithoutATemperatureAlone) {
  const ThermalView view = viewOf(plainImage());
  Wall wall(75.0, view);
  for (std::size_t i = 0; i < wall.found.size(); i += 2) wall.found[i].reset();
  const std::vector<GrazingView> views = wall.views();
  for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(std::isnan(views[i].incidence), i % 2 == 0);
  EXPECT_TRUE(readingNormals({}, {}, kEdge, kNoise).empty());
  EXPECT_TRUE(grazingViews({}, {}, {}, std::nullopt).empty());
}

TEST(Grazing, TakesTheSurroundingsFromTheFrameThenFromTheMission) {
  ThermalImage image = plainImage();
  EXPECT_EQ(reflectedTemperature(image, std::nullopt), 20.0);
  EXPECT_EQ(reflectedTemperature(image, 7.0), 7.0);
  RadiometricParameters parameters = sc660();
  parameters.reflected = -30.0;
  image.air = std::make_shared<const AirPath>(parameters);
  EXPECT_EQ(reflectedTemperature(image, 7.0), -30.0);
}

TEST(Grazing, SurvivesPointsBeyondEveryMap) {
  const ThermalView view = viewOf(plainImage());
  Wall wall(0.0, view);
  for (PlacedReturn& placed : wall.returns) placed.p_world *= 1e200;
  EXPECT_TRUE(std::isnan(wall.views()[0].incidence));
}

}  // namespace
}  // namespace thermovox::test
