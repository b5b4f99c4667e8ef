#include "projection/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "projection/error.hpp"
#include "tests/projection/matchers.hpp"
#include "tests/projection/random_cameras.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::intrinsicsOf;
using test::IsNear;
using test::messageOf;
using test::randomLens;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::span<const double, 8> distortionOf(const Intrinsics& in) {
  return std::span<const double, 8>(in.parameters.data() + kDistortion, 8);
}

/// Distorted radius of an undistorted one, written down once more, as the oracle of the validity bound.
double radialMap(const Intrinsics& in, double r) {
  const auto d = distortionOf(in);
  if (in.model == LensModel::kannala_brandt) {
    const double t = std::atan(r);
    return t + d[0] * std::pow(t, 3) + d[1] * std::pow(t, 5) + d[2] * std::pow(t, 7) + d[3] * std::pow(t, 9);
  }
  return r * (1 + d[0] * r * r + d[1] * std::pow(r, 4) + d[4] * std::pow(r, 6)) /
         (1 + d[5] * r * r + d[6] * std::pow(r, 4) + d[7] * std::pow(r, 6));
}

double radialDenominator(const Intrinsics& in, double r) {
  const auto d = distortionOf(in);
  if (in.model == LensModel::kannala_brandt) return 1.0;
  return 1 + d[5] * r * r + d[6] * std::pow(r, 4) + d[7] * std::pow(r, 6);
}

/// Slope of the radial map by the five-point formula.
double radialSlope(const Intrinsics& in, double r) {
  const double h = 1e-4 * std::max(r, 0.1);
  return (8 * (radialMap(in, r + h) - radialMap(in, r - h)) - radialMap(in, r + 2 * h) +
          radialMap(in, r - 2 * h)) /
         (12 * h);
}

/// The map grows everywhere below the bound, and at a finite bound it has ceased to (or runs into a pole).
void expectMonotonicUpToTheBound(const Intrinsics& in) {
  constexpr double kFurthest = 8.0;  // 83 degrees off the axis
  const double bound = Camera(in).validRadius();
  ASSERT_GT(bound, 0.0);
  for (double r = 1e-3; r < std::min(kFurthest, 0.999 * bound); r += 1e-3) {
    ASSERT_GT(radialSlope(in, r), -1e-9) << "r " << r << ", bound " << bound;
    ASSERT_GT(radialDenominator(in, r), 0.0) << "r " << r << ", bound " << bound;
  }
  if (bound < kFurthest && std::abs(radialDenominator(in, bound)) > 1e-3) {
    EXPECT_NEAR(radialSlope(in, bound), 0.0, 1e-4) << "bound " << bound << " narrower than needed";
  }
}

TEST(ValidRadius, IsWhereTheRadialMapStopsGrowing) {
  std::mt19937_64 random(17);
  for (const test::Lens& lens : test::kLenses) {
    for (int i = 0; i < 100; ++i) {
      SCOPED_TRACE(testing::Message() << lens.name << ' ' << i);
      ASSERT_NO_FATAL_FAILURE(
          expectMonotonicUpToTheBound(randomLens(lens.model, lens.distortion_count, random)));
    }
  }
}

TEST(ValidRadius, HoldsForCoefficientsOfVeryDifferentSize) {
  for (const double last :
       {0.0, 1e-6, -1e-6, 1e-9, -1e-9, 1e-15, -1e-15, 1e-40, -1e-40, 1e-300, -1e-300, 5e-324}) {
    SCOPED_TRACE(testing::Message() << "last coefficient " << last);
    expectMonotonicUpToTheBound(intrinsicsOf(LensModel::brown_conrady, {-0.35, 0.05, 0, 0, last}));
    expectMonotonicUpToTheBound(
        intrinsicsOf(LensModel::brown_conrady, {-0.35, 0.05, 0, 0, 0.01, 0.1, 0.02, last}));
    expectMonotonicUpToTheBound(intrinsicsOf(LensModel::kannala_brandt, {-0.25, -0.04, 0.01, last}));
    EXPECT_NEAR(Camera(intrinsicsOf(LensModel::brown_conrady, {-0.35, 0, 0, 0, last})).validRadius(),
                std::sqrt(1 / (3 * 0.35)), 1e-4);
  }
}

TEST(ValidRadius, IsInfiniteWhereTheMapAlwaysGrows) {
  EXPECT_EQ(Camera(intrinsicsOf(LensModel::pinhole, {})).validRadius(), kInfinity);
  EXPECT_EQ(Camera(intrinsicsOf(LensModel::brown_conrady, {0, 0, 0, 0})).validRadius(), kInfinity);
  EXPECT_EQ(Camera(intrinsicsOf(LensModel::brown_conrady, {0.1, 0.02, 0.001, 0.001, 0.003})).validRadius(),
            kInfinity);
  EXPECT_EQ(Camera(intrinsicsOf(LensModel::kannala_brandt, {0.01, 0.001, 0, 0})).validRadius(), kInfinity);
}

TEST(ValidRadius, OfAOneCoefficientBarrelIsTheClosedForm) {
  // d (r - k r^3) / dr = 0 at r = 1 / sqrt(3 k)
  EXPECT_NEAR(Camera(intrinsicsOf(LensModel::brown_conrady, {-0.3, 0, 0, 0})).validRadius(),
              1 / std::sqrt(0.9), 1e-12);
  EXPECT_NEAR(Camera(intrinsicsOf(LensModel::kannala_brandt, {-0.3, 0, 0, 0})).validRadius(),
              std::tan(1 / std::sqrt(0.9)), 1e-12);
}

TEST(Project, NeverFoldsTheWorldBackIntoTheImage) {
  const Camera camera(intrinsicsOf(LensModel::brown_conrady, {-0.35, 0, 0.001, -0.001, 0}));
  const double bound = camera.validRadius();
  int folded = 0;
  for (double r = 0.999 * bound; r < 20.0; r *= 1.001) {
    const Eigen::Vector3d p_camera(0.6 * r, 0.8 * r, 1.0);
    EXPECT_EQ(camera.projectUnbounded(p_camera).has_value(), r < bound) << r;
    const Eigen::Vector2d formula =
        pixelFromCamera(LensModel::brown_conrady, camera.intrinsics().parameters.data(), p_camera);
    const bool lands =
        formula.x() >= 0 && formula.x() < camera.width() && formula.y() >= 0 && formula.y() < camera.height();
    folded += lands && r > bound ? 1 : 0;
  }
  EXPECT_GT(folded, 100) << "the lens of this test should fold";
}

TEST(Project, RejectsPointsThatNoPixelSees) {
  for (const test::Lens& lens : test::kLenses) {
    std::mt19937_64 random(2);
    const Camera camera(randomLens(lens.model, lens.distortion_count, random));
    for (const Eigen::Vector3d& p_camera :
         std::initializer_list<Eigen::Vector3d>{{0, 0, -1},
                                                {0, 0, 0},
                                                {0.1, 0.1, -5},
                                                {1, 0, 0},  // behind, or beside
                                                {100, 0, 1},
                                                {0, -100, 1},  // outside
                                                {kNan, 0, 1},
                                                {0, kNan, 1},
                                                {0, 0, kNan},  // not finite
                                                {kInfinity, 0, 1},
                                                {0, -kInfinity, 1},
                                                {0, 0, kInfinity},
                                                {1e300, 1e300, 1}}) {
      EXPECT_FALSE(camera.project(p_camera)) << lens.name << ' ' << p_camera.transpose();
    }
  }
}

TEST(Project, TakesThePixelsOfTheImageToTheirOuterEdges) {
  const Camera camera(intrinsicsOf(LensModel::pinhole, {}, 160, 120));
  const auto sees = [&](double u, double v) {
    const auto& p = camera.intrinsics().parameters;
    return camera.project({(u - p[kCx]) / p[kFx], (v - p[kCy]) / p[kFy], 1.0}).has_value();
  };
  constexpr double kHair = 1e-9;
  EXPECT_TRUE(sees(-0.5 + kHair, 50));
  EXPECT_FALSE(sees(-0.5 - kHair, 50));
  EXPECT_TRUE(sees(159.5 - kHair, 50));
  EXPECT_FALSE(sees(159.5 + kHair, 50));
  EXPECT_TRUE(sees(50, -0.5 + kHair));
  EXPECT_FALSE(sees(50, -0.5 - kHair));
  EXPECT_TRUE(sees(50, 119.5 - kHair));
  EXPECT_FALSE(sees(50, 119.5 + kHair));
}

TEST(Project, HasTheLowerEdgeInTheImageAndTheUpperOutside) {
  Intrinsics in = intrinsicsOf(LensModel::pinhole, {}, 160, 120);
  in.parameters[kFx] = in.parameters[kFy] = 128.0;  // powers of two: the pixels below are exact
  in.parameters[kCx] = in.parameters[kCy] = 63.5;
  const Camera camera(in);
  EXPECT_TRUE(camera.project({-0.5, -0.5, 1.0}));  // (-0.5, -0.5)
  EXPECT_FALSE(camera.project({0.75, 0.0, 1.0}));  // (159.5, 63.5)
  EXPECT_TRUE(camera.projectUnbounded({0.75, 0.0, 1.0}));
}

TEST(RayFromPixel, KnowsNoRayForWhatTheLensNeverReaches) {
  // This barrel's image ends at a radius of (2 / 3) / sqrt(3 * 0.35) = 0.65 focal lengths.
  const Camera camera(intrinsicsOf(LensModel::brown_conrady, {-0.35, 0, 0, 0}));
  const auto& p = camera.intrinsics().parameters;
  EXPECT_TRUE(camera.rayFromPixel({p[kCx] + 0.64 * p[kFx], p[kCy]}));
  EXPECT_FALSE(camera.rayFromPixel({p[kCx] + 0.66 * p[kFx], p[kCy]}));
  EXPECT_FALSE(camera.rayFromPixel({1e9, 0}));
  EXPECT_FALSE(camera.rayFromPixel({kNan, 0}));
  EXPECT_FALSE(camera.rayFromPixel({0, kInfinity}));
}

TEST(Camera, RefusesIntrinsicsThatCannotBe) {
  const auto refusal = [](auto&& change) {
    Intrinsics in = intrinsicsOf(LensModel::brown_conrady, {0.1, 0, 0, 0});
    change(in);
    return messageOf<ConfigError>([&] { Camera camera(in); });
  };
  EXPECT_THAT(refusal([](Intrinsics& in) { in.width_px = 0; }), HasSubstr("0 x 512"));
  EXPECT_THAT(refusal([](Intrinsics& in) { in.height_px = -3; }), HasSubstr("-3"));
  EXPECT_THAT(refusal([](Intrinsics& in) { in.parameters[kFx] = 0.0; }), HasSubstr("fx"));
  EXPECT_THAT(refusal([](Intrinsics& in) { in.parameters[kFy] = -150.0; }), HasSubstr("-150"));
  EXPECT_THAT(refusal([](Intrinsics& in) { in.parameters[kCx] = kNan; }), HasSubstr("finite"));
  EXPECT_THAT(refusal([](Intrinsics& in) { in.parameters[kDistortion] = kInfinity; }), HasSubstr("finite"));
  EXPECT_THAT(refusal([](Intrinsics& in) { in.distortion_count = 6; }),
              HasSubstr("6 distortion coefficients"));
  EXPECT_THAT(refusal([](Intrinsics& in) { in.model = LensModel::pinhole; }),
              HasSubstr("4 distortion coefficients"));
}

}  // namespace
}  // namespace thermovox
