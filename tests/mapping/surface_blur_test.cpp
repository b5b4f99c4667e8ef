#include "mapping/surface_blur.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

namespace thermovox {
namespace {

using PixelByP = Eigen::Matrix<double, 2, 3>;

constexpr double kBlur = 0.7;  // px

Camera lensOf(double k1 = 0.0) {
  Intrinsics intrinsics{.width_px = 160, .height_px = 120, .model = LensModel::brown_conrady};
  intrinsics.parameters = {152.0, 150.0, 80.0, 60.0, k1};
  intrinsics.distortion_count = 4;
  return Camera(intrinsics);
}

Eigen::Matrix3d covarianceOf(const SurfaceBlur& blur) {
  return blur.variance * Eigen::Matrix3d::Identity() + blur.oblique * blur.oblique.transpose();
}

/// Where the rays through pixels that scatter about that of `p` meet the surface there: their covariance.
Eigen::Matrix3d scatterOnSurface(const Camera& lens, const Eigen::Vector3d& p,
                                 const Eigen::Vector3d& normal) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, kBlur);
  const Eigen::Vector2d pixel = *lens.project(p);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  constexpr int kRays = 20000;
  for (int i = 0; i < kRays; ++i) {
    const Eigen::Vector3d ray = *lens.rayFromPixel(pixel + Eigen::Vector2d(noise(random), noise(random)));
    const Eigen::Vector3d off = ray * (p.dot(normal) / ray.dot(normal)) - p;
    squares += off * off.transpose() / kRays;
  }
  return squares;
}

TEST(SurfaceBlur, IsWhereBlurredRaysMeetTheSurface) {
  const Camera lens = lensOf(-0.2);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.0, 0.0, 3.0), Eigen::Vector3d(0.9, -0.6, 3.0)}) {
    for (const double angle : {0.0, 0.5, 1.0}) {
      const Eigen::Vector3d n(std::sin(angle), 0.1, -std::cos(angle));
      const Eigen::Vector3d normal = n.normalized();
      const PixelByP view = lens.jacobian(p);
      const SurfaceBlur blur = surfaceBlur({&view, 1}, normal, kBlur);
      EXPECT_NEAR(blur.oblique.dot(normal), 0.0, 1e-9);
      const Eigen::Matrix3d on_surface = Eigen::Matrix3d::Identity() - normal * normal.transpose();
      const Eigen::Matrix3d expected = scatterOnSurface(lens, p, normal);
      const Eigen::Matrix3d found = on_surface * covarianceOf(blur) * on_surface;
      EXPECT_LT((found - expected).norm(), 0.04 * expected.norm()) << p.transpose() << " at " << angle;
    }
  }
}

TEST(SurfaceBlur, OfAnUnknownNormalFacesTheCamera) {
  const PixelByP view = lensOf().jacobian({0.0, 0.0, 2.0});
  const SurfaceBlur blur = surfaceBlur({&view, 1}, Eigen::Vector3d::Zero(), kBlur);
  EXPECT_NEAR(std::sqrt(blur.variance), 2.0 * kBlur / 152.0, 1e-9);
  EXPECT_TRUE(blur.fromTheFront());
}

TEST(SurfaceBlur, IsFromTheFrontUpTo65DegreesAndEndsAt78) {
  const PixelByP view = lensOf().jacobian({0.0, 0.0, 2.0});
  const auto at = [&](double degrees) {
    const double a = degrees * M_PI / 180.0;
    return surfaceBlur({&view, 1}, {std::sin(a), 0.0, std::cos(a)}, kBlur);
  };
  EXPECT_TRUE(at(64.0).fromTheFront());
  EXPECT_FALSE(at(66.5).fromTheFront());
  EXPECT_NEAR(at(60.0).variance + at(60.0).oblique.squaredNorm(), std::pow(2.0 * 2.0 * kBlur / 152.0, 2),
              1e-9);
  EXPECT_NEAR(at(85.0).oblique.norm(), at(89.9).oblique.norm(), 1e-5);
  EXPECT_TRUE(std::isfinite(at(90.0).oblique.norm()));
}

TEST(SurfaceBlur, OfSeveralViewsIsBetweenThemAndNearerToTheSharper) {
  const std::vector<PixelByP> views{lensOf().jacobian({0.0, 0.0, 2.0}), lensOf().jacobian({0.0, 0.0, 4.0})};
  const Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  const double near = surfaceBlur({&views[0], 1}, normal, kBlur).variance;
  const double far = surfaceBlur({&views[1], 1}, normal, kBlur).variance;
  EXPECT_NEAR(surfaceBlur(views, normal, kBlur).variance, 2.0 / (1.0 / near + 1.0 / far), 1e-12);
}

class BlurOfSample : public testing::Test {
 protected:
  /// A camera that looks along x from (x, 0, 0), seconds after the epoch.
  void look(double x, int seconds) {
    Eigen::Matrix3d R_world_camera;
    R_world_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    camera.frames.push_back({Time(std::chrono::seconds(seconds)),
                             {Eigen::Quaterniond(R_world_camera), Eigen::Vector3d(x, 0.0, 0.0)}});
  }
  [[nodiscard]] double widthOf(const SurfaceSample& of) const {
    return std::sqrt(blurOf(of, Eigen::Vector3d::UnitX(), camera).variance) * 152.0 / imageBlur(camera);
  }

  CameraSight camera{.focal_px = 152.0, .blur_px = kBlur, .bias_sigma = 0.0, .lens = lensOf()};
  SurfaceSample sample{.key = {},
                       .p_world = {4.0, 0.0, 0.0},
                       .celsius = 20.0F,
                       .sigma = 0.1F,
                       .observations = 1,
                       .returns = 1,
                       .best_view = {3.0F, std::numeric_limits<float>::quiet_NaN()},
                       .first = Time(std::chrono::seconds(10)),
                       .last = Time(std::chrono::seconds(20))};
};

TEST_F(BlurOfSample, OfOneTemperatureIsThatOfTheFrameAsFarAway) {
  for (const double x : {0.0, 1.0, 2.0}) look(x, 15);
  EXPECT_NEAR(widthOf(sample), 3.0, 0.02);
}

TEST_F(BlurOfSample, TakesNoFrameOfAnotherTimeAndNoneThatLookedAway) {
  look(1.05, 30);
  look(7.0, 15);  // as far, behind its back
  look(1.1, 15);
  EXPECT_NEAR(widthOf(sample), 2.9, 0.02);
}

TEST_F(BlurOfSample, OfSeveralIsThatOfAllFramesThatWereNoNearer) {
  sample.observations = 2;
  for (const double x : {-2.0, 1.0, 3.0}) look(x, 15);  // 6, 3 and 1 m
  EXPECT_NEAR(widthOf(sample), std::sqrt(2.0 / (1.0 / 9.0 + 1.0 / 36.0)), 0.02);
}

TEST_F(BlurOfSample, WithoutFramesGoesByRangeAndIncidence) {
  EXPECT_NEAR(widthOf(sample), 3.0, 1e-6);
  sample.best_view.incidence = static_cast<float>(M_PI / 3.0);
  const SurfaceBlur blur = blurOf(sample, Eigen::Vector3d::UnitX(), camera);
  EXPECT_NEAR(blur.variance + blur.oblique.squaredNorm(), 4.0 * blur.variance, 1e-3 * blur.variance);
}

TEST(SightOf, ACameraTakesItsFocalLengthAndBlur) {
  ThermalCamera thermal{.camera = lensOf(), .bias_sigma = 2.0, .blur_px = 0.6, .knows_blur = true};
  const CameraSight sight = sightOf(thermal);
  EXPECT_NEAR(sight.focal_px, std::sqrt(152.0 * 150.0), 1e-9);
  EXPECT_EQ(sight.bias_sigma, 2.0);
  EXPECT_NEAR(imageBlur(sight), std::sqrt(0.36 + 1.0 / 6.0), 1e-12);
  thermal.knows_blur = false;
  EXPECT_GT(sightOf(thermal).blur_sigma, 5.0 * sight.blur_sigma);
}

}  // namespace
}  // namespace thermovox
