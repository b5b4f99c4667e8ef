#include "calibration/board_plane.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

constexpr std::array<LaserKind, 3> kKinds{LaserKind::beam, LaserKind::scan, LaserKind::cloud};

Pose boardAhead() {
  return laserBesideCamera().inverse() * boardsHeld(1, 2).front();
}

/// Returns of the plate alone.
ReturnSet onPlate(LaserKind kind, double sigma, Chance& chance) {
  ReturnSet returns;
  for (const Eigen::Vector3d& ray : raysOf(kind)) {
    if (const auto range = rangeOfPlate(ray, boardAhead(), plate()))
      returns.emplace_back((*range + chance.normal(sigma)) * ray);
  }
  return returns;
}

/// n / d of the plate, as far as the kind of laser sees it.
Eigen::Vector3d trueInversePlane(LaserKind kind) {
  const Eigen::Vector3d normal = boardAhead().rotation * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d q = normal / normal.dot(boardAhead().translation);
  q.tail(3 - dimensionsOf(kind)).setZero();
  return q;
}

/// Sum of the squares, in sigmas, of what ranges differ from a plane.
double bruteForce(const ReturnSet& returns, const Eigen::Vector3d& q, double bias, double sigma) {
  double sum = 0.0;
  for (const Eigen::Vector3d& p : returns)
    sum += std::pow((p.norm() + bias - 1.0 / q.dot(p.normalized())) / sigma, 2);
  return sum;
}

TEST(PlaneMoments, FindTheExactPlaneWithoutNoise) {
  Chance chance(1);
  for (const LaserKind kind : kKinds) {
    const auto moments = planeMoments(onPlate(kind, 0.0, chance), kind, 0.01);
    ASSERT_TRUE(moments);
    EXPECT_THAT(moments->inverse_plane, IsNear(trueInversePlane(kind), 1e-12));
    EXPECT_EQ(moments->outliers, 0);
  }
}

TEST(PlaneMoments, SayWhatAllRaysSayToSecondOrder) {
  Chance chance(2);
  for (const LaserKind kind : kKinds) {
    const ReturnSet returns = onPlate(kind, 0.002, chance);
    const auto moments = planeMoments(returns, kind, 0.002);
    ASSERT_TRUE(moments);
    ASSERT_EQ(moments->outliers, 0);
    ASSERT_EQ(moments->channel_effect, 1.0);
    const double least = bruteForce(returns, moments->inverse_plane, 0.0, moments->sigma);
    for (const double scale : {1e-1, 1e-2, 1e-3}) {
      const Eigen::Vector3d change = scale * chance.normal3().normalized();
      Eigen::Vector4d unknowns;
      unknowns << change, scale * chance.normal();
      const double exact =
          bruteForce(returns, moments->inverse_plane + change, unknowns[3], moments->sigma) - least;
      const double summed =
          (moments->slope * unknowns + moments->offset).squaredNorm() - moments->offset.squaredNorm();
      // What is left out of a residual is its own square over the range: of the order of `scale` of it
      // (ranges are about 1 m). Plane and bias may cancel in the sum, not in its error.
      const double parts = bruteForce(returns, moments->inverse_plane + change, 0.0, moments->sigma) +
                           bruteForce(returns, moments->inverse_plane, unknowns[3], moments->sigma);
      EXPECT_NEAR(summed, exact, 5.0 * scale * parts) << dimensionsOf(kind) << ", " << scale;
    }
  }
}

TEST(PlaneMoments, EstimateTheNoiseOfARange) {
  Chance chance(3);
  for (const LaserKind kind : kKinds) {
    const ReturnSet returns = onPlate(kind, 0.006, chance);
    const auto moments = planeMoments(returns, kind, 0.006);
    ASSERT_TRUE(moments);
    // Four standard errors of a sigma of so many ranges; the rejection at 3.5 sigmas takes 0.3 per cent.
    EXPECT_NEAR(moments->sigma, 0.006,
                0.006 * (4.0 / std::sqrt(2.0 * static_cast<double>(returns.size())) + 0.003));
  }
}

TEST(PlaneMoments, TrustTheRigsSigmaWhereReturnsAreFew) {
  const auto moments = planeMoments({{1.0, 0.0, 0.0}}, LaserKind::beam, 0.02);
  ASSERT_TRUE(moments);
  EXPECT_NEAR(moments->sigma, 0.02, 1e-12);
  EXPECT_EQ(moments->returns, 1);
}

TEST(PlaneMoments, LeaveOutReturnsOfSomethingElse) {
  Chance chance(4);
  for (const LaserKind kind : kKinds) {
    ReturnSet returns = onPlate(kind, 0.0, chance);
    const std::size_t all = returns.size();
    int planted = 0;
    for (std::size_t i = 3; i < all; i += 15, ++planted) returns[i] *= 1.2;
    const auto moments = planeMoments(returns, kind, 0.01);
    ASSERT_TRUE(moments);
    EXPECT_EQ(moments->outliers, planted);
    EXPECT_EQ(moments->returns, static_cast<int>(all) - planted);
    EXPECT_THAT(moments->inverse_plane, IsNear(trueInversePlane(kind), 1e-12));
  }
}

TEST(PlaneMoments, TakeWhiteNoiseForWhatItIs) {
  Chance chance(5);
  int taken_for_channels = 0;
  for (int i = 0; i < 100; ++i) {
    const auto moments = planeMoments(onPlate(LaserKind::cloud, 0.01, chance), LaserKind::cloud, 0.01);
    ASSERT_TRUE(moments);
    taken_for_channels += moments->channel_effect > 1.0 ? 1 : 0;
    EXPECT_LT(moments->channel_effect, 4.0);
  }
  // About twenty rings: a ratio beyond two happens once in a hundred times, and costs little.
  EXPECT_LE(taken_for_channels, 5);
}

TEST(PlaneMoments, SeeThatChannelsErrTogether) {
  Chance chance(6);
  ReturnSet returns = onPlate(LaserKind::cloud, 0.005, chance);
  std::map<long, double> bias;  // of each ring
  for (Eigen::Vector3d& p : returns) {
    const long ring = std::lround(std::asin(p.z() / p.norm()) / (0.5 * kDegree));
    if (bias.count(ring) == 0) bias[ring] = chance.normal(0.005);
    p += bias[ring] * p.normalized();
  }
  const auto moments = planeMoments(returns, LaserKind::cloud, 0.005);
  ASSERT_TRUE(moments);
  ASSERT_GE(bias.size(), 15U);
  // Biases as large as the noise: one and as many as a ring has returns; that of n rings to sqrt(2 / n).
  const double expected = 1.0 + static_cast<double>(returns.size()) / static_cast<double>(bias.size());
  const double error = 4.0 * std::sqrt(2.0 / static_cast<double>(bias.size() - 3));
  EXPECT_GT(moments->channel_effect, expected * (1.0 - error));
  EXPECT_LT(moments->channel_effect, expected * (1.0 + error));
  const auto white = planeMoments(onPlate(LaserKind::cloud, 0.005, chance), LaserKind::cloud, 0.005);
  ASSERT_TRUE(white);
  EXPECT_LT(moments->slope.norm() * moments->sigma, 0.5 * white->slope.norm() * white->sigma);
}

TEST(PlaneMoments, SpreadTheirCornerRays) {
  Chance chance(7);
  for (const LaserKind kind : kKinds) {
    const auto moments = planeMoments(onPlate(kind, 0.0, chance), kind, 0.01);
    ASSERT_TRUE(moments);
    const auto corners = static_cast<std::size_t>(dimensionsOf(kind) + 1);
    ASSERT_EQ(moments->corner_rays.size(), corners);
    ASSERT_EQ(moments->corner_ranges.size(), corners);
    for (std::size_t i = 0; i < corners; ++i) {
      EXPECT_NEAR(moments->corner_ranges[i],
                  rangeOfPlate(moments->corner_rays[i], boardAhead(), plate()).value(), 1e-9);
    }
    double widest = 0.0;
    for (const Eigen::Vector3d& ray : moments->corner_rays)
      widest = std::max(widest, (ray - moments->corner_rays.front()).norm());
    EXPECT_GT(widest, kind == LaserKind::beam ? -1.0 : 0.2);
  }
}

TEST(PlaneMoments, NeedReturnsThatSpanAPlane) {
  EXPECT_FALSE(planeMoments({}, LaserKind::beam, 0.01));
  EXPECT_FALSE(planeMoments({{1.0, 0.2, 0.0}}, LaserKind::scan, 0.01));
  EXPECT_FALSE(planeMoments(ReturnSet(20, Eigen::Vector3d(1.0, 0.2, 0.0)), LaserKind::scan, 0.01))
      << "one ray twenty times";
  EXPECT_FALSE(planeMoments({{1.0, 0.2, 0.0}, {1.0, -0.2, 0.1}}, LaserKind::cloud, 0.01));
  ReturnSet line;  // one ring of a cloud
  for (int i = -10; i <= 10; ++i) line.emplace_back(1.0, 0.02 * i, 0.0);
  EXPECT_FALSE(planeMoments(line, LaserKind::cloud, 0.01));
  EXPECT_TRUE(planeMoments(line, LaserKind::scan, 0.01));
}

}  // namespace
}  // namespace thermovox::test
