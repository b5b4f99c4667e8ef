#include "apps/simulate/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "apps/simulate/thermal_render.hpp"
#include "projection/error.hpp"
#include "tests/apps/simulated_sweeps.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::simulate {
namespace {

/// Every valid return with its place by the written trajectory and the written rig: what a reader computes.
struct PlacedReturn {
  Time stamp;
  Eigen::Vector3d p_world;
  Eigen::Vector3d origin_world;
};

std::vector<PlacedReturn> placeReturns(const Simulation& simulation) {
  const Trajectory trajectory(simulation.writtenPoses());
  std::vector<PlacedReturn> placed;
  for (std::size_t sweep = 0; sweep < simulation.sweepCount(); ++sweep) {
    for (const LaserReturn& echo : readSweep(simulation, sweep).returns) {
      const auto T_world_body = trajectory.at(echo.stamp);
      if (!std::holds_alternative<Pose>(T_world_body)) continue;
      const Pose T_world_laser = std::get<Pose>(T_world_body) * simulation.rig().lasers.front().T_body_laser;
      placed.push_back({echo.stamp, T_world_laser * echo.p_laser, T_world_laser.translation});
    }
  }
  return placed;
}

struct ErrorSummary {
  std::size_t count = 0;
  double mae = 0.0;
  double rms = 0.0;
};

ErrorSummary summarise(const std::vector<double>& errors) {
  ErrorSummary summary{errors.size(), 0.0, 0.0};
  for (const double e : errors) {
    summary.mae += std::abs(e) / static_cast<double>(errors.size());
    summary.rms += e * e / static_cast<double>(errors.size());
  }
  summary.rms = std::sqrt(summary.rms);
  return summary;
}

/// Colours returns with the frame nearest in time under perfect visibility: rays cast in the true hall.
class TrueColouring {
 public:
  explicit TrueColouring(const Simulation& simulation)
      : simulation_(simulation), camera_(simulation.rig().thermal_camera->camera) {
    const ThermalRenderer renderer(simulation);
    const TLinear& t_linear = *simulation.rig().thermal_camera->t_linear;
    for (std::size_t frame = 0; frame < simulation.frameCount(); ++frame) {
      std::vector<double>& image = frames_.emplace_back();
      for (const std::uint16_t count : renderer.counts(frame)) image.push_back(t_linear.celsius(count));
    }
  }

  /// Temperature of the point minus that of the true surface there, of all points that the frame sees.
  [[nodiscard]] std::vector<double> errors(const std::vector<PlacedReturn>& returns) const {
    std::vector<double> errors;
    for (const PlacedReturn& placed : returns) {
      const double since_start = toSeconds(placed.stamp - simulation_.frameStamp(0));
      const double nearest = std::round(since_start * simulation_.options().frame_rate);
      const auto frame =
          static_cast<std::size_t>(std::clamp(nearest, 0.0, static_cast<double>(frames_.size() - 1)));
      const Pose T_world_body = simulation_.truePose(simulation_.frameStamp(frame));
      const Pose T_world_camera = T_world_body * simulation_.rig().thermal_camera->T_body_camera;
      const auto pixel = camera_.project(T_world_camera.inverse() * placed.p_world);
      if (!pixel || simulation_.hall().occluded(T_world_camera.translation, placed.p_world)) continue;
      const auto shown = bilinear(frames_[frame], *pixel);
      if (shown) errors.push_back(*shown - simulation_.hall().temperatureAt(placed.p_world));
    }
    return errors;
  }

 private:
  [[nodiscard]] std::optional<double> bilinear(const std::vector<double>& image,
                                               const Eigen::Vector2d& pixel) const {
    const int u = static_cast<int>(std::floor(pixel.x()));
    const int v = static_cast<int>(std::floor(pixel.y()));
    if (u < 0 || v < 0 || u + 1 >= camera_.width() || v + 1 >= camera_.height()) return std::nullopt;
    const auto at = [&](int du, int dv) {
      return image[static_cast<std::size_t>((v + dv) * camera_.width() + u + du)];
    };
    const double a = pixel.x() - u;
    const double b = pixel.y() - v;
    return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
  }

  const Simulation& simulation_;
  const Camera& camera_;
  std::vector<std::vector<double>> frames_;
};

double rmsToSurface(const Simulation& simulation, const std::vector<PlacedReturn>& returns) {
  std::vector<double> distances;
  for (const auto& placed : returns) {
    distances.push_back(simulation.hall().nearestSurface(placed.p_world).distance);
  }
  return summarise(distances).rms;
}

TEST(Simulation, RefusesOptionsThatMakeNoSense) {
  const auto refused = [](auto change) {
    SimulationOptions options;
    change(options);
    return test::messageOf<ConfigError>([&] { Simulation simulation(options); });
  };
  EXPECT_THAT(refused([](auto& o) { o.duration = 0.0; }), testing::HasSubstr("duration"));
  EXPECT_THAT(refused([](auto& o) { o.duration = std::nan(""); }), testing::HasSubstr("duration"));
  EXPECT_THAT(refused([](auto& o) { o.outlier_share = 1.5; }), testing::HasSubstr("outlier_share"));
  EXPECT_THAT(refused([](auto& o) { o.threads = 0; }), testing::HasSubstr("threads"));
  EXPECT_THAT(refused([](auto& o) { o.errors.covariance_body_laser(2, 2) = -1.0; }),
              testing::HasSubstr("covariance"));
}

TEST(Simulation, RangeNoiseHasTheDeclaredSpreadAlongTheRay) {
  for (const LaserKind kind : kKinds) {
    SimulationOptions options = optionsOf(kind, kind == LaserKind::beam ? 6.0 : 1.0);
    options.range_sigma = 0.02;
    const Simulation simulation(options);
    std::vector<double> residuals;
    double mean = 0.0;
    for (std::size_t sweep = 0; sweep < simulation.sweepCount(); ++sweep) {
      for (const LaserReturn& echo : readSweep(simulation, sweep).returns) {
        const Pose T_world_laser = simulation.truePose(echo.stamp) * simulation.trueBodyLaser();
        const Eigen::Vector3d d_world = T_world_laser.rotation * echo.p_laser.normalized();
        const auto hit = simulation.hall().castRay(T_world_laser.translation, d_world);
        ASSERT_TRUE(hit);
        const double residual = echo.range() - hit->range;
        // A few rays graze an edge, where the float of the file lies on the other side of it.
        if (std::abs(residual) < 6.0 * options.range_sigma) residuals.push_back(residual);
      }
    }
    for (const double r : residuals) mean += r / static_cast<double>(residuals.size());
    const double n = static_cast<double>(residuals.size());
    ASSERT_GT(n, 500.0);
    EXPECT_NEAR(mean, 0.0, 4.0 * 0.02 / std::sqrt(n));
    EXPECT_NEAR(summarise(residuals).rms, 0.02, 4.0 * 0.02 / std::sqrt(2.0 * n));
  }
}

TEST(Simulation, WeakEchoesAreTheDeclaredShareAndTheGateDropsThem) {
  SimulationOptions options = optionsOf(LaserKind::cloud, 1.0);
  options.outlier_share = 0.05;
  const Simulation simulation(options);
  std::size_t weak = 0;
  std::size_t all = 0;
  for (std::size_t sweep = 0; sweep < simulation.sweepCount(); ++sweep) {
    const Reading reading = readSweep(simulation, sweep);
    weak += reading.dropped.too_weak;
    all += reading.returns.size() + reading.dropped.total();
  }
  EXPECT_NEAR(static_cast<double>(weak) / static_cast<double>(all), 0.05, 0.004);
  EXPECT_LT(rmsToSurface(simulation, placeReturns(simulation)), 0.0105);
}

// The independent simulator's halls give MAE 0.067 (cloud) to 0.077 C (beam) and rms 0.27 to 0.32 C; edges
// and hot spots make the errors, so the figure varies with the hall.
TEST(Simulation, ReaderWithPerfectVisibilityFindsTheTrueTemperatures) {
  for (const LaserKind kind : kKinds) {
    const Simulation simulation(optionsOf(kind, 6.0));
    const std::vector<PlacedReturn> returns = placeReturns(simulation);
    EXPECT_LT(rmsToSurface(simulation, returns), 0.0105);  // range_sigma and the interpolation of poses
    const ErrorSummary colour = summarise(TrueColouring(simulation).errors(returns));
    EXPECT_GT(colour.count, returns.size() / 10);
    EXPECT_LT(colour.mae, 0.12);
    EXPECT_LT(colour.rms, 0.6);
  }
}

TEST(Simulation, DeskewMattersInEverySweep) {
  for (const LaserKind kind : {LaserKind::scan, LaserKind::cloud}) {
    const Simulation simulation(optionsOf(kind, 1.0));
    std::vector<double> distances;
    for (std::size_t sweep = 0; sweep < simulation.sweepCount(); ++sweep) {
      const Reading reading = readSweep(simulation, sweep);
      const Pose at_start = simulation.truePose(reading.stamp) * simulation.trueBodyLaser();
      for (const LaserReturn& echo : reading.returns) {
        distances.push_back(simulation.hall().nearestSurface(at_start * echo.p_laser).distance);
      }
    }
    EXPECT_GT(summarise(distances).rms, 0.02);
  }
}

TEST(Simulation, DrawnErrorsHaveTheDeclaredCovariance) {
  SimulationOptions options = optionsOf(LaserKind::beam, 0.1);
  Vector6d sigmas;
  sigmas << 0.004, 0.006, 0.008, 0.01, 0.02, 0.03;
  options.errors.covariance_body_laser = sigmas.cwiseAbs2().asDiagonal();
  options.errors.pose_rotation_sigma = 0.005;
  options.errors.pose_translation_sigma = 0.02;
  options.errors.range_bias_sigma = 0.03;
  Vector6d squares = Vector6d::Zero();
  Eigen::Vector3d pose_squares = Eigen::Vector3d::Zero();
  constexpr int kDraws = 600;
  for (int i = 0; i < kDraws; ++i) {
    options.seed = static_cast<std::uint64_t>(i);
    const Simulation simulation(options);
    const Pose& written = simulation.rig().lasers.front().T_body_laser;
    const Pose& actual = simulation.trueBodyLaser();
    const Eigen::AngleAxisd turn(actual.rotation * written.rotation.conjugate());
    squares.head<3>() += (turn.angle() * turn.axis()).cwiseAbs2() / kDraws;
    squares.tail<3>() += (actual.translation - written.translation).cwiseAbs2() / kDraws;
    const StampedPose first = simulation.writtenPoses().front();
    const Pose true_first = simulation.truePose(first.stamp);
    pose_squares.x() +=
        std::pow(true_first.rotation.angularDistance(first.T_world_body.rotation), 2) / kDraws;
    pose_squares.y() += (true_first.translation - first.T_world_body.translation).squaredNorm() / kDraws;
    pose_squares.z() += std::pow(simulation.drawnErrors().range_bias, 2) / kDraws;
  }
  // The variance of a variance over 600 draws is 6 %; four of these.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(squares[i] / (sigmas[i] * sigmas[i]), 1.0, 0.24) << i;
  EXPECT_NEAR(pose_squares.x() / (3 * 0.005 * 0.005), 1.0, 0.24);
  EXPECT_NEAR(pose_squares.y() / (3 * 0.02 * 0.02), 1.0, 0.24);
  EXPECT_NEAR(pose_squares.z() / (0.03 * 0.03), 1.0, 0.24);
}

TEST(ThermalRenderer, FlatWallShowsItsTemperatureWithTheDeclaredNoise) {
  SimulationOptions options = optionsOf(LaserKind::scan, 1.0);
  options.netd = 0.08;
  const Simulation simulation(options);
  const ThermalRenderer renderer(simulation);
  const std::vector<float> clean = renderer.render(simulation.truePose(simulation.frameStamp(1)));
  const std::vector<std::uint16_t> counts = renderer.counts(1);
  std::vector<double> noise;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    noise.push_back(simulation.rig().thermal_camera->t_linear->celsius(counts[i]) - clean[i]);
  }
  EXPECT_NEAR(summarise(noise).rms, 0.08, 0.002);
}

/// Second moment, about the true edge, of the step from the end wall to the ceiling, over all phases of the
/// edge between pixels: the square of the blur, and 1/12 for taking differences of pixels.
double blurOfLevelEdge(const Simulation& simulation) {
  const ThermalRenderer renderer(simulation);
  const ThermalCamera& thermal = *simulation.rig().thermal_camera;
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  const Eigen::Vector3d size = simulation.hall().size();
  const double depth = size.x() / 2 + 3.0;
  double moment = 0.0;
  constexpr int kPhases = 10;
  for (int phase = 0; phase < kPhases; ++phase) {
    const double edge = 50.0 + phase / static_cast<double>(kPhases);
    const double below = (thermal.camera.intrinsics().parameters[kCy] - edge) * depth / thermal.camera.fy();
    const Pose T_world_camera{Eigen::Quaterniond(R_world_camera), {-3.0, 0.0, size.z() - below}};
    const std::vector<float> image = renderer.render(T_world_camera * thermal.T_body_camera.inverse());
    for (int v = 40; v < 60; ++v) {
      const auto i = static_cast<std::size_t>(v * thermal.camera.width() + 80);
      const double step = image[i + static_cast<std::size_t>(thermal.camera.width())] - image[i];
      moment += step * std::pow(v + 0.5 - edge, 2) / kPhases;
    }
  }
  return std::sqrt(moment / (Hall::kEndWallCelsius - Hall::kFloorCelsius) - 1.0 / 12.0);
}

TEST(ThermalRenderer, EdgesAreAsBlurredAsTheRigSays) {
  for (const double blur : {0.3, 0.6, 1.0}) {
    SimulationOptions options = optionsOf(LaserKind::scan, 1.0);
    options.lens = LensModel::pinhole;
    options.blur_px = blur;
    EXPECT_NEAR(blurOfLevelEdge(Simulation(options)), blur, 0.02);
  }
}

TEST(ThermalRenderer, WideLensRendersToo) {
  SimulationOptions options = optionsOf(LaserKind::scan, 1.0);
  options.lens = LensModel::kannala_brandt;
  const Simulation simulation(options);
  const auto counts = ThermalRenderer(simulation).counts(0);
  EXPECT_THAT(counts, testing::Each(testing::AllOf(testing::Gt(28000), testing::Lt(38000))));
  const ErrorSummary colour = summarise(TrueColouring(simulation).errors(placeReturns(simulation)));
  EXPECT_LT(colour.mae, 0.25);  // a pixel is 1.4 times as large as that of the other lens
}

}  // namespace
}  // namespace thermovox::simulate
