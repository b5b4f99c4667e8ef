// Cameras against what we did not write: OpenCV's projections and the derivatives of ceres::Jet.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <array>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "projection/camera.hpp"
#include "tests/projection/matchers.hpp"
#include "tests/projection/random_cameras.hpp"

namespace thermovox {
namespace {

using test::IsNear;
using test::randomLens;
using test::randomPoint;

class EveryLens : public testing::TestWithParam<test::Lens> {
 protected:
  static constexpr int kCameras = 40;
  std::mt19937_64 random_{7};

  Camera nextCamera() { return Camera(randomLens(GetParam().model, GetParam().distortion_count, random_)); }
};

std::vector<cv::Point2d> projectWithOpenCv(const Intrinsics& in, const std::vector<cv::Point3d>& points) {
  const auto& p = in.parameters;
  const cv::Matx33d K(p[kFx], 0, p[kCx], 0, p[kFy], p[kCy], 0, 0, 1);
  const std::vector<double> distortion(p.begin() + kDistortion,
                                       p.begin() + kDistortion + in.distortion_count);
  const cv::Vec3d none(0, 0, 0);
  std::vector<cv::Point2d> pixels;
  if (in.model == LensModel::kannala_brandt) {
    cv::fisheye::projectPoints(points, pixels, none, none, K, distortion);
  } else {
    cv::projectPoints(points, none, none, K, distortion, pixels);
  }
  return pixels;
}

TEST_P(EveryLens, ProjectsAsOpenCvDoes) {
  for (int c = 0; c < kCameras; ++c) {
    const Camera camera = nextCamera();
    std::vector<cv::Point3d> points;
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d p = randomPoint(camera, 1.0, 1.5, random_);
      points.emplace_back(p.x(), p.y(), p.z());
    }
    const std::vector<cv::Point2d> expected = projectWithOpenCv(camera.intrinsics(), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p_camera(points[i].x, points[i].y, points[i].z);
      const auto pixel = camera.projectUnbounded(p_camera);
      ASSERT_TRUE(pixel) << p_camera.transpose();
      EXPECT_THAT(*pixel, IsNear(Eigen::Vector2d(expected[i].x, expected[i].y), 1e-9))
          << p_camera.transpose();
    }
  }
}

TEST_P(EveryLens, InvertsItsOwnProjection) {
  for (int c = 0; c < kCameras; ++c) {
    const Camera camera = nextCamera();
    for (int i = 0; i < 200; ++i) {
      // At the valid radius itself the inverse has no slope any more, so not quite there.
      const Eigen::Vector3d p_camera = randomPoint(camera, 0.95, 1.5, random_);
      const Eigen::Vector2d pixel = camera.projectUnbounded(p_camera).value();
      const auto ray = camera.rayFromPixel(pixel);
      ASSERT_TRUE(ray) << "camera " << c << ", point " << (p_camera / p_camera.z()).transpose();
      EXPECT_THAT(*ray, IsNear(Eigen::Vector3d(p_camera / p_camera.z()), 1e-9)) << pixel.transpose();
    }
  }
}

TEST_P(EveryLens, FindsForEveryPixelARayThatProjectsThereOrNone) {
  for (int c = 0; c < kCameras; ++c) {
    const Camera camera = nextCamera();
    for (int v = 0; v < camera.height(); v += 37) {
      for (int u = 0; u < camera.width(); u += 41) {
        const auto ray = camera.rayFromPixel(Eigen::Vector2d(u, v));
        if (!ray) continue;
        const auto pixel = camera.project(*ray);
        ASSERT_TRUE(pixel) << u << ' ' << v;
        EXPECT_THAT(*pixel, IsNear(Eigen::Vector2d(u, v), 1e-7));
      }
    }
  }
}

TEST_P(EveryLens, HasTheJacobianOfItsOwnTemplate) {
  using Jet = ceres::Jet<double, 3>;
  for (int c = 0; c < kCameras; ++c) {
    const Camera camera = nextCamera();
    std::array<Jet, kCameraParameters> parameters;
    for (int k = 0; k < kCameraParameters; ++k) parameters[k] = Jet(camera.intrinsics().parameters[k]);
    for (int i = 0; i < 100; ++i) {
      // Towards the poles of an 8-coefficient lens both lose digits, so not quite there.
      const Eigen::Vector3d p_camera = randomPoint(camera, 0.95, 1.5, random_);
      const Vec3<Jet> p(Jet(p_camera.x(), 0), Jet(p_camera.y(), 1), Jet(p_camera.z(), 2));
      const Vec2<Jet> pixel = pixelFromCamera(camera.intrinsics().model, parameters.data(), p);
      Eigen::Matrix<double, 2, 3> expected;
      expected << pixel.x().v.transpose(), pixel.y().v.transpose();
      EXPECT_THAT(camera.jacobian(p_camera), IsNear(expected, 1e-10 * (1.0 + expected.norm())))
          << p_camera.transpose();
      const Eigen::Vector2d value(pixel.x().a, pixel.y().a);
      EXPECT_THAT(value, IsNear(camera.projectUnbounded(p_camera).value(), 1e-12 * (1.0 + value.norm())));
    }
  }
}

TEST_P(EveryLens, HasTheJacobianOfFiniteDifferences) {
  for (int c = 0; c < kCameras; ++c) {
    const Camera camera = nextCamera();
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d p_camera = randomPoint(camera, 0.9, 1.2, random_);
      const double h = 1e-5 * p_camera.z();
      Eigen::Matrix<double, 2, 3> expected;
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
        expected.col(axis) = (camera.projectUnbounded(p_camera + step).value() -
                              camera.projectUnbounded(p_camera - step).value()) /
                             (2 * h);
      }
      // Central differences: the third derivative times h^2, and 1e-13 px of rounding over h.
      EXPECT_THAT(camera.jacobian(p_camera), IsNear(expected, 1e-6 * (1.0 + expected.norm())))
          << p_camera.transpose();
    }
  }
}

TEST_P(EveryLens, OnTheAxisHasTheJacobianOfAPinhole) {
  const Camera camera = nextCamera();
  Eigen::Matrix<double, 2, 3> expected;
  expected << camera.fx() / 4.0, 0, 0, 0, camera.fy() / 4.0, 0;
  EXPECT_THAT(camera.jacobian({0, 0, 4.0}), IsNear(expected, 1e-12));
  const Eigen::Vector2d centre(camera.intrinsics().parameters[kCx], camera.intrinsics().parameters[kCy]);
  EXPECT_THAT(camera.project({0, 0, 4.0}).value(), IsNear(centre, 1e-12));
  EXPECT_THAT(camera.rayFromPixel(centre).value(), IsNear(Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST_P(EveryLens, DifferentiatesByItsParametersToo) {
  using Jet = ceres::Jet<double, kCameraParameters>;
  for (int c = 0; c < kCameras; ++c) {
    const Camera camera = nextCamera();
    std::array<double, kCameraParameters> values = camera.intrinsics().parameters;
    std::array<Jet, kCameraParameters> jets;
    for (int k = 0; k < kCameraParameters; ++k) jets[k] = Jet(values[k], k);
    const Eigen::Vector3d p_camera = randomPoint(camera, 0.9, 1.0, random_);
    const Vec2<Jet> pixel = pixelFromCamera<Jet>(GetParam().model, jets.data(), p_camera.cast<Jet>());
    for (int k = 0; k < kCameraParameters; ++k) {
      constexpr double kStep = 1e-6;
      const double value = values[k];
      values[k] = value + kStep;
      const Eigen::Vector2d above = pixelFromCamera(GetParam().model, values.data(), p_camera);
      values[k] = value - kStep;
      const Eigen::Vector2d below = pixelFromCamera(GetParam().model, values.data(), p_camera);
      values[k] = value;
      const Eigen::Vector2d derivative(pixel.x().v[k], pixel.y().v[k]);
      // Finite differences of a pixel coordinate of some 1e3: 1e-13 * 1e3 / 1e-6 of rounding.
      EXPECT_THAT(derivative,
                  IsNear(Eigen::Vector2d((above - below) / (2 * kStep)), 1e-5 * (1.0 + derivative.norm())))
          << "parameter " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Camera, EveryLens, testing::ValuesIn(test::kLenses),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace thermovox
