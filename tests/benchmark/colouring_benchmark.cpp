// Colouring: points a second on one core, next to OpenCV projecting and sampling the same points.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "projection/colouring_batch.hpp"
#include "projection/depth_sectors.hpp"

namespace thermovox {
namespace {

constexpr int kPointsAcross = 500;
constexpr int kPoints = kPointsAcross * 400;

enum class Spread { in_view, in_view_through_air, all_round };

Camera benchmarkLens() {
  Intrinsics in{.width_px = 160, .height_px = 120, .model = LensModel::brown_conrady, .distortion_count = 5};
  in.parameters = {152.3, 151.6, 78.9, 61.2, -0.21, 0.07, 0.0012, -0.0008, 0.0};
  return Camera(in);
}

/// With air: as a radiometric camera's frame in a mission.
ThermalFrame benchmarkFrame(Spread spread) {
  std::mt19937_64 random(1);
  std::normal_distribution<float> noise(0.0F, 0.05F);
  auto image = std::make_shared<ThermalImage>(ThermalImage{.width = 160, .height = 120});
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u)
      image->celsius.push_back((u / 20 + v / 20) % 2 == 0 ? 21.0F + noise(random) : 45.0F);
  }
  RadiometricParameters parameters{.planck = {21106.77, 0.012545258, 1501.0, 1.0, -7340.0}};
  if (spread == Spread::in_view_through_air) image->air = std::make_shared<const AirPath>(parameters);
  return {.stamp = Time(), .image = std::move(image), .name = "benchmark"};
}

/// A camera in a hall, and laser points around it whose extrinsics have a declared covariance.
struct Scene {
  ThermalCamera camera{.camera = benchmarkLens()};
  Pose T_world_camera{expRotation({0.5, -1.1, 0.3}), {12.0, -7.0, 3.0}};
  Laser laser{.kind = LaserKind::cloud,
              .T_body_laser = {expRotation({1.2, -1.2, 1.2}), {0.1, 0.0, 0.05}},
              .range_sigma = 0.01};
  Mission mission{.trajectory =
                      Trajectory({{Time(), T_world_camera}, {Time(std::chrono::hours(1)), T_world_camera}})};
  ThermalView view;
  DepthSectors sectors{camera.camera, view.T_camera_world, {}};
  std::vector<LaserReturn> returns;
  std::vector<PlacedReturn> points;
  std::vector<Eigen::Vector3d> positions;

  explicit Scene(Spread spread) : view(benchmarkFrame(spread), T_world_camera, camera) {
    Vector6d sigmas;
    sigmas << 0.002, 0.002, 0.002, 0.005, 0.005, 0.005;
    laser.covariance_body_laser = sigmas.cwiseAbs2().asDiagonal();
    std::mt19937_64 random(2);
    const Pose T_laser_camera = laser.T_body_laser.inverse();  // the camera is the body here
    while (points.size() < kPoints) {
      const Eigen::Vector3d p_camera =
          onSurface(spread == Spread::all_round ? rayAllRound(random) : rayInView(random));
      returns.push_back({.stamp = Time(), .p_laser = T_laser_camera * p_camera});
      points.push_back(std::get<PlacedReturn>(place(returns.back(), laser, mission)));
      positions.push_back(points.back().p_world);
    }
    sectors.add(positions);
    sectors.finish();
  }

  /// A plate of 2 x 1.6 m at 4 m, walls and floor of a hall behind it.
  static Eigen::Vector3d onSurface(const Eigen::Vector3d& ray) {
    if (ray.z() > 0.0 && std::abs(ray.x() / ray.z()) < 0.25 && std::abs(ray.y() / ray.z()) < 0.2)
      return ray * (4.0 / ray.z());
    const Eigen::Vector3d scale = ray.cwiseAbs().cwiseQuotient(Eigen::Vector3d(8.0, 2.5, 10.0));
    return ray / scale.maxCoeff();
  }
  Eigen::Vector3d rayInView(std::mt19937_64& random) const {
    std::uniform_real_distribution<double> u(0.0, camera.camera.width() - 1.0),
        v(0.0, camera.camera.height() - 1.0);
    return camera.camera.rayFromPixel({u(random), v(random)}).value();
  }
  /// A laser that turns about the vertical: 360 degrees by 44, of which the camera sees some 15 %.
  Eigen::Vector3d rayAllRound(std::mt19937_64& random) const {
    std::uniform_real_distribution<double> azimuth(-M_PI, M_PI), elevation(-0.38, 0.38);
    const double a = azimuth(random);
    return {std::sin(a), std::tan(elevation(random)), std::cos(a)};
  }
};

const Scene& sceneOf(Spread spread) {
  static const Scene in_view(Spread::in_view);
  static const Scene through_air(Spread::in_view_through_air);
  static const Scene all_round(Spread::all_round);
  if (spread == Spread::in_view_through_air) return through_air;
  return spread == Spread::in_view ? in_view : all_round;
}

/// The peer: cv::projectPoints and a bilinear cv::remap, on one thread. No visibility, no sigma, and points
/// behind the camera are projected like the others.
class OpenCvColouring {
 public:
  explicit OpenCvColouring(const Scene& scene) {
    const auto& p = scene.camera.camera.intrinsics().parameters;
    K_ = cv::Matx33d(p[kFx], 0, p[kCx], 0, p[kFy], p[kCy], 0, 0, 1);
    distortion_.assign(p.begin() + kDistortion, p.begin() + kDistortion + 5);
    const Eigen::AngleAxisd rotation(scene.view.T_camera_world.rotation);
    const Eigen::Vector3d rvec = rotation.angle() * rotation.axis();
    rvec_ = {rvec.x(), rvec.y(), rvec.z()};
    const Eigen::Vector3d& t = scene.view.T_camera_world.translation;
    tvec_ = {t.x(), t.y(), t.z()};
    for (const Eigen::Vector3d& point : scene.positions)
      points_.emplace_back(point.x(), point.y(), point.z());
    image_ = cv::Mat(scene.view.frame.image->celsius, true).reshape(1, scene.view.frame.image->height);
  }

  void run() {
    cv::projectPoints(points_, rvec_, tvec_, K_, distortion_, pixels_);
    cv::Mat(pixels_).reshape(2, kPoints / kPointsAcross).convertTo(map_, CV_32FC2);
    cv::remap(image_, celsius_, map_, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
    benchmark::DoNotOptimize(celsius_.data);
  }

  /// Points a second of processor time, as the median of 15 runs.
  double rate() {
    cv::setNumThreads(1);
    std::vector<double> seconds;
    for (int i = 0; i < 15; ++i) {
      const std::clock_t start = std::clock();
      run();
      seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    std::nth_element(seconds.begin(), seconds.begin() + 7, seconds.end());
    return kPoints / seconds[7];
  }

 private:
  cv::Matx33d K_;
  std::vector<double> distortion_;
  cv::Vec3d rvec_, tvec_;
  std::vector<cv::Point3d> points_;
  std::vector<cv::Point2d> pixels_;
  cv::Mat image_, map_, celsius_;
};

/// A benchmark's clock and what it says of the points that went through: their share with a colour, and how
/// many times OpenCV's rate that is, measured here and now.
class Account {
 public:
  Account(benchmark::State& state, const Scene& scene, std::size_t points = kPoints)
      : state_(state), scene_(scene), points_(static_cast<double>(points)) {}
  ~Account() {
    const double seconds = static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
    const double points = static_cast<double>(state_.iterations()) * points_;
    state_.SetItemsProcessed(static_cast<std::int64_t>(points));
    state_.counters["coloured"] = static_cast<double>(coloured) / points_;
    state_.counters["times_opencv"] = points / seconds / OpenCvColouring(scene_).rate();
  }
  std::size_t coloured = 0;

 private:
  benchmark::State& state_;
  const Scene& scene_;
  double points_;
  std::clock_t start_ = std::clock();
};

/// One point after the other.
void colourPoints(benchmark::State& state, Spread spread, const Occluder& occluder) {
  const Scene& scene = sceneOf(spread);
  Account account(state, scene);
  for (auto _ : state) {
    account.coloured = 0;
    for (const PlacedReturn& point : scene.points) {
      const auto result = colour(point, scene.view, scene.camera, occluder);
      account.coloured += std::holds_alternative<Colour>(result) ? 1 : 0;
      benchmark::DoNotOptimize(&result);
    }
  }
}
void colourInView(benchmark::State& state) {
  colourPoints(state, Spread::in_view, sceneOf(Spread::in_view).sectors);
}
void colourAllRound(benchmark::State& state) {
  colourPoints(state, Spread::all_round, sceneOf(Spread::all_round).sectors);
}

/// All at once, at a level of vector instructions. Through memory go a PlacedReturn and a PointColour
/// for every point.
void colourBatch(benchmark::State& state, Spread spread, const Occluder& occluder,
                 std::size_t most = kPoints) {
  const auto level = static_cast<CpuLevel>(state.range(0));
  state.SetLabel(std::string(nameOf(level)));
  if (level > cpuLevel()) return state.SkipWithError("not on this processor");
  const Scene& scene = sceneOf(spread);
  ColouringBatch batch(level);
  Account account(state, scene, most);
  const std::span<const PlacedReturn> points(scene.points.data(), most);
  std::span<const PointColour> colours;
  for (auto _ : state) {
    colours = batch.colour(points, {scene.view, scene.camera, occluder});
    benchmark::DoNotOptimize(colours.data());
    benchmark::ClobberMemory();
  }
  account.coloured =
      static_cast<std::size_t>(std::count_if(colours.begin(), colours.end(), [](const PointColour& point) {
        return point.outcome == PointColour::Outcome::coloured;
      }));
  state.counters["bytes_a_point"] = sizeof(PlacedReturn) + sizeof(PointColour);
}
void colourBatchInView(benchmark::State& state) {
  colourBatch(state, Spread::in_view, sceneOf(Spread::in_view).sectors);
}
/// A reading that fits into the cache, as those of most lasers do.
void colourBatchOfAReading(benchmark::State& state) {
  colourBatch(state, Spread::in_view, sceneOf(Spread::in_view).sectors, 30'000);
}
/// A radiometric camera's frame: with the air on the way to each point.
void colourBatchOfAReadingThroughAir(benchmark::State& state) {
  colourBatch(state, Spread::in_view_through_air, sceneOf(Spread::in_view).sectors, 30'000);
}
void colourBatchInViewWithoutOccluder(benchmark::State& state) {
  colourBatch(state, Spread::in_view, NoOccluder());
}
void colourBatchAllRound(benchmark::State& state) {
  colourBatch(state, Spread::all_round, sceneOf(Spread::all_round).sectors);
}

/// Projection and bilinear sampling alone: what OpenCV does, too.
void sampleBatch(benchmark::State& state, Spread spread) {
  const auto level = static_cast<CpuLevel>(state.range(0));
  state.SetLabel(std::string(nameOf(level)));
  if (level > cpuLevel()) return state.SkipWithError("not on this processor");
  const Scene& scene = sceneOf(spread);
  ColouringBatch batch(level);
  Account account(state, scene);
  std::span<const float> celsius;
  for (auto _ : state) {
    celsius = batch.sample(scene.positions, scene.view);
    benchmark::DoNotOptimize(celsius.data());
    benchmark::ClobberMemory();
  }
  account.coloured = static_cast<std::size_t>(
      std::count_if(celsius.begin(), celsius.end(), [](float c) { return !std::isnan(c); }));
  state.counters["bytes_a_point"] = sizeof(Eigen::Vector3d) + sizeof(float);
}
void sampleBatchInView(benchmark::State& state) {
  sampleBatch(state, Spread::in_view);
}
void sampleBatchAllRound(benchmark::State& state) {
  sampleBatch(state, Spread::all_round);
}

void openCv(benchmark::State& state, Spread spread) {
  cv::setNumThreads(1);
  OpenCvColouring peer(sceneOf(spread));
  for (auto _ : state) peer.run();
  state.SetItemsProcessed(state.iterations() * kPoints);
}
void openCvInView(benchmark::State& state) {
  openCv(state, Spread::in_view);
}
void openCvAllRound(benchmark::State& state) {
  openCv(state, Spread::all_round);
}

void placeReturns(benchmark::State& state) {
  const Scene& scene = sceneOf(Spread::all_round);
  for (auto _ : state) {
    for (const LaserReturn& echo : scene.returns)
      benchmark::DoNotOptimize(place(echo, scene.laser, scene.mission));
  }
  state.SetItemsProcessed(state.iterations() * kPoints);
}

/// What a frame costs before its first point: the local variances, and the depth sectors of `range(0)`
/// points.
void makeThermalView(benchmark::State& state) {
  const Scene& scene = sceneOf(Spread::in_view);
  for (auto _ : state) {
    const ThermalView view(scene.view.frame, scene.T_world_camera, scene.camera);
    benchmark::DoNotOptimize(&view);
  }
}
void makeDepthSectors(benchmark::State& state) {
  const Scene& scene = sceneOf(Spread::in_view);
  const std::span<const Eigen::Vector3d> positions(scene.positions.data(),
                                                   static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    DepthSectors sectors(scene.camera.camera, scene.view.T_camera_world, {});
    sectors.add(positions);
    sectors.finish();
    benchmark::DoNotOptimize(&sectors);
  }
}

BENCHMARK(colourInView)->Unit(benchmark::kMillisecond);
BENCHMARK(colourAllRound)->Unit(benchmark::kMillisecond);
BENCHMARK(colourBatchInView)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(colourBatchOfAReading)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(colourBatchOfAReadingThroughAir)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(colourBatchInViewWithoutOccluder)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(colourBatchAllRound)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(sampleBatchInView)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(sampleBatchAllRound)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(openCvInView)->Unit(benchmark::kMillisecond);
BENCHMARK(openCvAllRound)->Unit(benchmark::kMillisecond);
BENCHMARK(placeReturns)->Unit(benchmark::kMillisecond);
BENCHMARK(makeThermalView)->Unit(benchmark::kMillisecond);
BENCHMARK(makeDepthSectors)->Arg(2'000)->Arg(20'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace thermovox
