// From a laser return to a temperature with its sigma, on scenes whose truth is known.
#include "projection/colouring.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/projection/matchers.hpp"
#include "tests/projection/scene.hpp"
#include "tests/support/radiometry.hpp"

namespace thermovox {
namespace {

using std::chrono::milliseconds;
using test::IsNear;

constexpr Time kStart{std::chrono::seconds(1'700'000'000)};
constexpr double kWall = 5.0;  // metres before the camera

ThermalCamera cameraOf(const Intrinsics& intrinsics) {
  return {.camera = Camera(intrinsics), .T_body_camera = {}, .netd = 0.05, .blur_px = 0.6};
}
ThermalCamera lens() {
  return cameraOf(
      test::intrinsicsOf(LensModel::brown_conrady, {-0.21, 0.07, 0.0012, -0.0008, 0.0}, 160, 120));
}

/// Temperature of the wall z = kWall (camera frame at the start) at (x, y).
double wallCelsius(double x, double y) {
  return 30.0 + 3.0 * x - 2.0 * y + 2.0 * std::sin(2.0 * x) * std::cos(1.5 * y);
}

/// What a camera at T_wall_camera sees of the wall.
ThermalImage imageOfWall(const Camera& camera, const Pose& T_wall_camera) {
  return test::imageOf(camera.width(), camera.height(), [&](int u, int v) {
    const Eigen::Vector3d ray = T_wall_camera.rotation * camera.rayFromPixel(Eigen::Vector2d(u, v)).value();
    const Eigen::Vector3d p =
        T_wall_camera.translation + ray * ((kWall - T_wall_camera.translation.z()) / ray.z());
    return wallCelsius(p.x(), p.y());
  });
}

PlacedReturn pointAt(const Eigen::Vector3d& p_world) {
  return {.stamp = kStart,
          .p_world = p_world,
          .origin_world = Eigen::Vector3d::Zero(),
          .range = p_world.norm(),
          .rig_covariance = Eigen::Matrix3d::Zero(),
          .pose_covariance = Eigen::Matrix3d::Zero()};
}

TEST(Colour, GivesEveryVisiblePointTheTemperatureOfItsPlace) {
  const ThermalCamera camera = lens();
  const Pose T_world_camera{expRotation({0.5, -1.0, 0.2}), {3, -4, 2}};
  const ThermalView view(test::frameOf(imageOfWall(camera.camera, {})), T_world_camera, camera);
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> x(-4.0, 4.0), y(-3.0, 3.0);
  int coloured = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d p_camera(x(random), y(random), kWall);
    const auto pixel = camera.camera.project(p_camera);
    const auto result = colour(pointAt(T_world_camera * p_camera), view, camera, NoOccluder());
    if (!pixel) {
      EXPECT_EQ(std::get<NoColour>(result), NoColour::outside_image);
      continue;
    }
    const bool rim = pixel->x() < 0 || pixel->y() < 0 || pixel->x() > 159 || pixel->y() > 119;
    if (rim) continue;  // the border repeats there
    ++coloured;
    ASSERT_TRUE(std::holds_alternative<Colour>(result)) << p_camera.transpose();
    const Colour& c = std::get<Colour>(result);
    // Bilinear error: an eighth of the second derivative (8 C/m^2) times the pixel's 3.3 cm squared, 1 mC.
    EXPECT_NEAR(c.celsius, wallCelsius(p_camera.x(), p_camera.y()), 5e-3);
    EXPECT_THAT(c.pixel, IsNear(*pixel, 1e-9));
    EXPECT_NEAR(c.range, p_camera.norm(), 1e-5);
    EXPECT_GE(c.sigma, camera.netd / 2 - 1e-6);  // four equal weights halve the noise, nothing does better
  }
  EXPECT_GT(coloured, 1000);
}

TEST(Colour, PutsTheAirOfItsOwnDistanceIntoEveryPoint) {
  // Walls of one temperature at many distances, through humid air: what the camera counts differs.
  const ThermalCamera camera = lens();
  RadiometricParameters parameters = test::sc660();
  parameters.atmosphere_temperature = 12.0;
  parameters.humidity = 0.9;
  constexpr double kObject = 85.0;
  for (const double depth : {1.0, 5.0, 20.0, 60.0}) {
    parameters.distance = depth;
    const double counts = countsOfCelsius(kObject, parameters);
    parameters.distance = 0.0;
    const double at_no_distance = celsiusOfCounts(counts, parameters);
    ThermalImage image = test::imageOf(160, 120, [&](int, int) { return at_no_distance; });
    image.air = std::make_shared<const AirPath>(parameters);
    const ThermalView view(test::frameOf(image), {}, camera);
    const Eigen::Vector3d ahead = depth * camera.camera.rayFromPixel({80.0, 60.0}).value().normalized();
    const Colour c = std::get<Colour>(colour(pointAt(ahead), view, camera, NoOccluder()));
    EXPECT_NEAR(c.celsius, kObject, 1e-4) << depth;  // floats of the image, made larger by the air
    EXPECT_NEAR(c.range, depth, 1e-5);
    // A difference in the image is a larger one at the object.
    const double slope = image.air->at(at_no_distance, depth).slope;
    EXPECT_GT(slope, 1.0);
    EXPECT_NEAR(c.sigma, camera.netd * slope, 1e-6) << depth;
  }
}

TEST(Colour, GivesNoTemperatureThatTheCountsCannotMean) {
  const ThermalCamera camera = lens();
  RadiometricParameters parameters = test::sc660();
  parameters.atmosphere_temperature = 40.0;
  ThermalImage image = test::imageOf(160, 120, [](int, int) { return -190.0; });
  image.air = std::make_shared<const AirPath>(parameters);
  const ThermalView view(test::frameOf(std::move(image)), {}, camera);
  EXPECT_EQ(std::get<NoColour>(colour(pointAt({0, 0, 50}), view, camera, NoOccluder())),
            NoColour::unknown_pixel);
}

TEST(Colour, SaysWhyThereIsNone) {
  struct Curtain final : Occluder {
    [[nodiscard]] bool hides(const Sight& sight) const override { return sight.depth > 4.0; }
  };
  const ThermalCamera camera = lens();
  const ThermalView view(test::frameOf(imageOfWall(camera.camera, {})), {}, camera);
  const auto reason = [&](const Eigen::Vector3d& p, const Occluder& occluder) {
    return std::get<NoColour>(colour(pointAt(p), view, camera, occluder));
  };
  EXPECT_EQ(reason({0, 0, 5}, Curtain()), NoColour::hidden);
  EXPECT_TRUE(std::holds_alternative<Colour>(colour(pointAt({0, 0, 3}), view, camera, Curtain())));
  EXPECT_EQ(reason({0, 0, -5}, NoOccluder()), NoColour::outside_image);
  EXPECT_EQ(reason({50, 0, 5}, NoOccluder()), NoColour::outside_image);
  EXPECT_EQ(reason({50, 0, 5}, Curtain()), NoColour::outside_image);  // outside before hidden
  EXPECT_EQ(reason({std::nan(""), 0, 5}, NoOccluder()), NoColour::outside_image);
}

TEST(Colour, AsksTheOccluderAboutTheSightItself) {
  struct Witness final : Occluder {
    mutable Sight seen;
    [[nodiscard]] bool hides(const Sight& sight) const override {
      seen = sight;
      return true;
    }
  };
  const ThermalCamera camera = lens();
  const Pose T_world_camera{expRotation({0.5, -1.0, 0.2}), {3, -4, 2}};
  const ThermalView view(test::frameOf(imageOfWall(camera.camera, {})), T_world_camera, camera);
  const Eigen::Vector3d p_camera(0.3, -0.4, 5.0);
  const Witness witness;
  (void)colour(pointAt(T_world_camera * p_camera), view, camera, witness);
  EXPECT_THAT(witness.seen.camera_world, IsNear(T_world_camera.translation, 1e-12));
  EXPECT_THAT(witness.seen.p_world, IsNear(T_world_camera * p_camera, 1e-12));
  EXPECT_THAT(witness.seen.pixel, IsNear(camera.camera.project(p_camera).value(), 1e-9));
  EXPECT_NEAR(witness.seen.depth, 5.0, 1e-12);
}

TEST(Colour, IsUnknownWhereThePixelsAre) {
  const ThermalCamera camera = lens();
  ThermalImage image = imageOfWall(camera.camera, {});
  for (int v = 50; v < 70; ++v) {
    for (int u = 70; u < 90; ++u) image.celsius[static_cast<std::size_t>(v * 160 + u)] = std::nanf("");
  }
  const ThermalView view(test::frameOf(std::move(image)), {}, camera);
  const auto at = [&](double u, double v) {
    return colour(pointAt(kWall * camera.camera.rayFromPixel({u, v}).value()), view, camera, NoOccluder());
  };
  EXPECT_EQ(std::get<NoColour>(at(80, 60)), NoColour::unknown_pixel);
  EXPECT_EQ(std::get<NoColour>(at(70.2, 50.2)), NoColour::unknown_pixel);
  ASSERT_TRUE(std::holds_alternative<Colour>(at(69.3, 60)));
  EXPECT_TRUE(std::isfinite(std::get<Colour>(at(69.3, 60)).celsius));
  EXPECT_TRUE(std::isfinite(std::get<Colour>(at(69.3, 60)).sigma));
}

TEST(Colour, SeesThePointFromWhereTheCameraWasWhenTheFrameWasTaken) {
  // The body turns 60 degrees a second; the return comes 20 ms after the frame: 3 px, 10 cm on the wall.
  ThermalCamera camera = lens();
  camera.T_body_camera = {expRotation({-0.02, 0.01, 0.03}), {0.1, 0.0, 0.05}};
  const Laser laser{.T_body_laser = {expRotation({0.0, -M_PI / 2, 0.0}), {0.0, 0.1, 0.0}}};
  const auto bodyAt = [](Duration since) {
    return Pose{expRotation({0.0, M_PI / 3 * toSeconds(since), 0.0}), {0.0, 0.0, toSeconds(since)}};
  };
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 10; ++i)
    poses.push_back({kStart + milliseconds(10 * i), bodyAt(milliseconds(10 * i))});
  const Mission mission{.trajectory = Trajectory(std::move(poses))};

  const Pose T_world_camera = bodyAt(milliseconds(45)) * camera.T_body_camera;
  const ThermalView view(test::frameOf(imageOfWall(camera.camera, T_world_camera), kStart + milliseconds(45)),
                         T_world_camera, camera);
  for (const Eigen::Vector2d& target :
       {Eigen::Vector2d(0.4, 0.2), Eigen::Vector2d(-0.7, 0.5), Eigen::Vector2d(0.9, -0.8)}) {
    const Eigen::Vector3d p_world(target.x(), target.y(), kWall);
    const Pose T_world_laser = bodyAt(milliseconds(65)) * laser.T_body_laser;
    const LaserReturn echo{.stamp = kStart + milliseconds(65), .p_laser = T_world_laser.inverse() * p_world};
    const auto placed = std::get<PlacedReturn>(place(echo, laser, mission));
    const Colour c = std::get<Colour>(colour(placed, view, camera, NoOccluder()));
    EXPECT_NEAR(c.celsius, wallCelsius(target.x(), target.y()), 5e-3);
    EXPECT_THAT(c.pixel, IsNear(camera.camera.project(T_world_camera.inverse() * p_world).value(), 1e-3));
    EXPECT_NEAR(c.range, (T_world_camera.inverse() * p_world).norm(), 1e-4);
    EXPECT_NEAR(placed.range, echo.p_laser.norm(),
                1e-12);  // the laser's own reading, not the camera's distance
  }
}

TEST(ColourSigma, IsTheNoiseAloneOnAFlatWall) {
  const ThermalCamera camera = lens();
  const ThermalView view(test::frameOf(test::imageOf(160, 120, [](int, int) { return 21.0; })), {}, camera);
  PlacedReturn point = pointAt({0.31, 0.17, kWall});
  point.rig_covariance = 1e-3 * Eigen::Matrix3d::Identity();
  const Colour c = std::get<Colour>(colour(point, view, camera, NoOccluder()));
  const float noise = sampleTemperature(*view.frame.image, c.pixel, camera.netd)->noise_sigma;
  EXPECT_NEAR(c.sigma, noise, 1e-4);
}

TEST(ColourSigma, OnARampIsTheGradientTimesThePixelError) {
  ThermalCamera camera = cameraOf(test::intrinsicsOf(LensModel::pinhole, {}, 160, 120));
  camera.netd = 0.0;
  const double gradient = 2.0;  // C a pixel, along u
  const ThermalView view(test::frameOf(test::imageOf(160, 120, [&](int u, int) { return gradient * u; })), {},
                         camera);
  for (const double sigma : {0.005, 0.02, 0.05}) {  // metres on each axis
    PlacedReturn point = pointAt({0.0, 0.0, kWall});
    point.rig_covariance = sigma * sigma * Eigen::Matrix3d::Identity();
    point.pose_covariance = 9.0 * Eigen::Matrix3d::Identity();  // moves camera and laser together
    const Colour c = std::get<Colour>(colour(point, view, camera, NoOccluder()));
    const double pixel_sigma = 0.5 * (camera.camera.fx() + camera.camera.fy()) * sigma / kWall;
    const double expected = gradient * std::hypot(camera.blur_px, pixel_sigma);
    EXPECT_NEAR(c.sigma / expected, 1.0, 0.03) << sigma;  // the window's cut-off, as in LocalVariance's tests
  }
}

/// An edge of 40 C through the image as the optics blur it, with the camera's noise; points of a wall around
/// it whose measured places are off by the extrinsics' error. The truth is the sharp edge.
struct EdgeScene {
  ThermalCamera camera = cameraOf(test::intrinsicsOf(LensModel::pinhole, {}, 160, 120));
  std::mt19937_64 random{41};
  std::normal_distribution<double> normal;
  double edge_u = 80.3;

  ThermalView view() {
    const auto blurred = [&](int u, int) {
      const double warm = 0.5 * std::erfc((edge_u - u) / (camera.blur_px * M_SQRT2));
      return 20.0 + 40.0 * warm + camera.netd * normal(random);
    };
    return {test::frameOf(test::imageOf(160, 120, blurred)), {}, camera};
  }
};

class Coverage : public testing::TestWithParam<double> {};

TEST_P(Coverage, NearAnEdgeHoldsTheTruthAsOftenAsTwoSigmasShould) {
  EdgeScene scene;
  const double sigma = GetParam() * kWall / scene.camera.camera.fx();  // metres for that many pixels
  std::uniform_real_distribution<double> offset(-5.0, 5.0), row(10.0, 110.0);
  int within_two = 0, points = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const ThermalView view = scene.view();
    for (int i = 0; i < 500; ++i, ++points) {
      const double u = scene.edge_u + offset(scene.random);
      const Eigen::Vector3d p_true = kWall * scene.camera.camera.rayFromPixel({u, row(scene.random)}).value();
      const Eigen::Vector3d error(scene.normal(scene.random), scene.normal(scene.random),
                                  scene.normal(scene.random));
      PlacedReturn point = pointAt(p_true + sigma * error);
      point.rig_covariance = sigma * sigma * Eigen::Matrix3d::Identity();
      const Colour c = std::get<Colour>(colour(point, view, scene.camera, NoOccluder()));
      const double truth = u > scene.edge_u ? 60.0 : 20.0;
      within_two += std::abs(c.celsius - truth) <= 2.0 * c.sigma ? 1 : 0;
    }
  }
  const double share = static_cast<double>(within_two) / points;
  // Here an error is all of the 40 C or nothing. Two sigmas hold it as often as a normal distribution's (95
  // %) up to a pixel of error; beyond, the far points that err seldom claim too little to cover it.
  EXPECT_GT(share, GetParam() <= 1.0 ? 0.93 : 0.88);
}

INSTANTIATE_TEST_SUITE_P(ColourSigma, Coverage, testing::Values(0.0, 0.3, 0.7, 1.0, 2.0));

TEST(ColourSigma, DistrustsEdgesAndTrustsTheFlatBesideThem) {
  EdgeScene scene;
  const ThermalView view = scene.view();
  const auto sigmaAt = [&](double u) {
    const Eigen::Vector3d p = kWall * scene.camera.camera.rayFromPixel({u, 60.0}).value();
    return std::get<Colour>(colour(pointAt(p), view, scene.camera, NoOccluder())).sigma;
  };
  EXPECT_GT(sigmaAt(80.3), 5.0F);
  EXPECT_LT(sigmaAt(70.0), 0.15F);
  EXPECT_LT(sigmaAt(90.0), 0.15F);
}

}  // namespace
}  // namespace thermovox
