#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "apps/simulate/simulation.hpp"
#include "apps/simulate/visible_render.hpp"
#include "io/visible_edges.hpp"
#include "tests/apps/simulated_sweeps.hpp"

namespace thermovox::simulate {
namespace {

/// A flight whose visible camera's pictures are laid over its thermal frames.
struct Pair {
  Simulation simulation{[] {
    SimulationOptions options = optionsOf(LaserKind::cloud, 1.0);
    options.visible = SimulationOptions::VisibleCamera::present;
    return options;
  }()};
  const Camera& thermal = simulation.rig().thermal_camera->camera;
  const Camera& visible = simulation.rig().visible_camera->camera;
  Pose T_world_thermal, T_world_visible;

  explicit Pair(std::size_t frame) {
    const Pose T_world_body = simulation.truePose(simulation.frameStamp(frame));
    T_world_thermal = T_world_body * simulation.rig().thermal_camera->T_body_camera;
    T_world_visible = T_world_body * simulation.rig().visible_camera->T_body_camera;
  }

  /// Depths at the thermal pixels as the laser's sweeps about the frame tell them.
  [[nodiscard]] std::vector<double> depthsOfLaser(Time frame) const {
    const Pose T_body_laser = simulation.trueBodyLaser();
    std::vector<PixelDepth> points;
    for (std::size_t sweep = 0; sweep < simulation.sweepCount(); ++sweep) {
      for (const LaserReturn& ret : readSweep(simulation, sweep).returns) {
        if (std::abs(std::chrono::duration<double>(ret.stamp - frame).count()) > 0.15) continue;
        const Eigen::Vector3d p_world = simulation.truePose(ret.stamp) * (T_body_laser * ret.p_laser);
        if (simulation.hall().occluded(T_world_thermal.translation, p_world)) continue;
        const Eigen::Vector3d p_thermal = T_world_thermal.inverse() * p_world;
        if (const auto pixel = thermal.project(p_thermal)) points.push_back({*pixel, p_thermal.z()});
      }
    }
    EXPECT_GT(points.size(), 500U);
    return nearestDepths(thermal.width(), thermal.height(), points);
  }

  /// The visible picture on the thermal pixels.
  [[nodiscard]] cv::Mat registered(std::span<const double> depths) const {
    const RegisteredPicture picture{
        {visible.width(), visible.height(), renderVisible(simulation.hall(), visible, T_world_visible)},
        registerPixels({thermal, visible, T_world_visible.inverse() * T_world_thermal}, depths)};
    return asMat(resample(picture, 1).luminance);
  }
  /// What the thermal camera would see if it were a visible one: the truth to register to.
  [[nodiscard]] cv::Mat truth() const {
    return asMat(renderVisible(simulation.hall(), thermal, T_world_thermal));
  }
  [[nodiscard]] cv::Mat asMat(const std::vector<std::uint8_t>& luminance) const {
    cv::Mat picture(thermal.height(), thermal.width(), CV_32F);
    std::copy(luminance.begin(), luminance.end(), picture.begin<float>());
    return picture;
  }
};

/// How far two pictures of the same are apart, px, by correlating their phases.
double shiftBetween(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat window;
  cv::createHanningWindow(window, a.size(), CV_32F);
  const cv::Point2d shift = cv::phaseCorrelate(a, b, window);
  return std::hypot(shift.x, shift.y);
}

TEST(VisibleRegistration, LiesWithinAPixelOfWhatTheThermalCameraSees) {
  const std::array frames{std::size_t{0}, std::size_t{2}, std::size_t{4}};
  for (const std::size_t frame : frames) {
    const Pair pair(frame);
    const cv::Mat registered = pair.registered(pair.depthsOfLaser(pair.simulation.frameStamp(frame)));
    const cv::Mat truth = pair.truth();
    EXPECT_LT(shiftBetween(registered, truth), 0.3) << frame;
    for (int v = 0; v + 60 <= truth.rows; v += 30) {
      for (int u = 0; u + 80 <= truth.cols; u += 40) {
        const cv::Rect part(u, v, 80, 60);
        EXPECT_LT(shiftBetween(registered(part), truth(part)), 1.0) << frame << ": " << u << ", " << v;
      }
    }
  }
}

TEST(VisibleRegistration, IsOffWhereTheDistanceIsWrong) {
  const Pair pair(0);
  EXPECT_GT(shiftBetween(pair.registered(std::array{1.0}), pair.truth()), 3.0);
}

TEST(RenderVisible, IsTheSameFromTheSamePlace) {
  const Pair pair(1);
  const auto render = [&] {
    return renderVisible(pair.simulation.hall(), pair.thermal, pair.T_world_thermal);
  };
  const std::vector<std::uint8_t> luminance = render();
  EXPECT_EQ(luminance.size(), 160U * 120U);
  EXPECT_EQ(luminance, render());
}

}  // namespace
}  // namespace thermovox::simulate
