// The batch against colour(), its serial version: to the bit, on every lens, at every level.
#include "projection/colouring_batch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "projection/depth_sectors.hpp"
#include "tests/projection/scene.hpp"
#include "tests/support/radiometry.hpp"

namespace thermovox {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<CpuLevel> levels() {
  std::vector<CpuLevel> levels;
  for (const CpuLevel level : {CpuLevel::baseline, CpuLevel::avx2, CpuLevel::avx512}) {
    if (level <= cpuLevel()) levels.push_back(level);
  }
  return levels;
}

/// No air, that of the one model, that of the other, in turns.
std::shared_ptr<const AirPath> airOf(int seed) {
  if (seed % 3 == 0) return nullptr;
  RadiometricParameters parameters = test::sc660();
  parameters.model = seed % 3 == 1 ? AtmosphereModel::single : AtmosphereModel::half;
  parameters.window_transmission = 0.9;
  parameters.reflected = -20.0;
  return std::make_shared<const AirPath>(parameters);
}

/// A frame of noise with holes, seen from somewhere, and points before, beside and behind it.
struct RandomScene {
  std::mt19937_64 random;
  ThermalCamera camera;
  Pose T_world_camera{expRotation({0.5, -1.0, 0.2}), {431.0, -74.0, 12.0}};
  ThermalView view;
  std::vector<PlacedReturn> points;

  RandomScene(const test::Lens& lens, int seed)
      : random(static_cast<std::uint64_t>(seed)),
        camera{.camera = Camera(lensOf(lens))},
        view(test::frameOf(imageWithHoles(airOf(seed))), T_world_camera, camera) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 3001; ++i) {
      const double z = 6.0 + 7.0 * uniform(random);
      const Eigen::Vector3d p_camera(0.8 * z * uniform(random), 0.7 * z * uniform(random), z);
      points.push_back(pointAt(T_world_camera * p_camera, 0.1 * std::pow(10.0, 2.0 * uniform(random))));
    }
    addOddities();
  }

  Intrinsics lensOf(const test::Lens& lens) {
    Intrinsics in = test::randomLens(lens.model, lens.distortion_count, random);
    const double scale = 120.0 / in.width_px;
    in.width_px = 120;
    in.height_px = 96;
    for (int k = kFx; k < kDistortion; ++k) in.parameters[static_cast<std::size_t>(k)] *= scale;
    return in;
  }
  ThermalImage imageWithHoles(std::shared_ptr<const AirPath> air) {
    std::uniform_real_distribution<double> celsius(15.0, 90.0), hole(0.0, 1.0);
    ThermalImage image = test::imageOf(120, 96, [&](int u, int v) {
      const bool known = hole(random) > 0.15 && !(u > 30 && u < 45 && v > 20 && v < 40);
      return known ? celsius(random) : kNan;
    });
    image.air = std::move(air);
    return image;
  }
  PlacedReturn pointAt(const Eigen::Vector3d& p_world, double sigma) {
    std::normal_distribution<double> normal;
    Eigen::Matrix3d a;
    for (double& entry : a.reshaped()) entry = sigma * normal(random);
    return {.p_world = p_world,
            .origin_world = Eigen::Vector3d::Zero(),
            .range = 1.0,
            .rig_covariance = a * a.transpose(),
            .pose_covariance = Eigen::Matrix3d::Zero()};
  }
  void addOddities() {
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double odd : {kNan, infinite, -infinite, 0.0, 1e300, -1e300, 1e-310}) {
      for (int axis = 0; axis < 3; ++axis) {
        points.push_back(pointAt(points[static_cast<std::size_t>(7 * axis)].p_world, 0.01));
        points.back().p_world[axis] = odd;
        points.push_back(pointAt(points[static_cast<std::size_t>(11 * axis)].p_world, 0.01));
        points.back().rig_covariance = odd * Eigen::Matrix3d::Ones();
      }
    }
    points.push_back(pointAt(T_world_camera.translation, 0.01));  // the camera's own centre
    const Eigen::Vector3d ahead(0.0, 0.0, 5.0);
    points.push_back(pointAt(T_world_camera * ahead, 0.01));  // on the axis
    std::shuffle(points.begin(), points.end(), random);
  }

  [[nodiscard]] DepthSectors sectors() const {
    DepthSectors sectors(camera.camera, view.T_camera_world, {});
    for (std::size_t i = 0; i < points.size(); i += 2) sectors.add(points[i].p_world);
    sectors.finish();
    return sectors;
  }
};

struct Tally {
  int coloured = 0, outside = 0, hidden = 0, unknown = 0;
};

void expectSame(const std::variant<Colour, NoColour>& found, const std::variant<Colour, NoColour>& expected) {
  ASSERT_EQ(found.index(), expected.index());
  if (const NoColour* reason = std::get_if<NoColour>(&expected)) {
    EXPECT_EQ(std::get<NoColour>(found), *reason);
    return;
  }
  const Colour& a = std::get<Colour>(found);
  const Colour& b = std::get<Colour>(expected);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.pixel.x()), std::bit_cast<std::uint64_t>(b.pixel.x()));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.pixel.y()), std::bit_cast<std::uint64_t>(b.pixel.y()));
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a.celsius), std::bit_cast<std::uint32_t>(b.celsius));
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a.range), std::bit_cast<std::uint32_t>(b.range));
  EXPECT_TRUE(std::bit_cast<std::uint32_t>(a.sigma) == std::bit_cast<std::uint32_t>(b.sigma) ||
              (std::isnan(a.sigma) && std::isnan(b.sigma)))
      << a.sigma << " and " << b.sigma;
}

class EveryLensInABatch : public testing::TestWithParam<test::Lens> {};

TEST_P(EveryLensInABatch, ColoursABatchAsItColoursItsPoints) {
  Tally tally;
  for (int seed = 0; seed < 5; ++seed) {
    const RandomScene scene(GetParam(), seed);
    const DepthSectors sectors = scene.sectors();
    for (const CpuLevel level : levels()) {
      SCOPED_TRACE(nameOf(level));
      ColouringBatch batch(level);
      const auto colours = batch.colour(scene.points, {scene.view, scene.camera, sectors});
      ASSERT_EQ(colours.size(), scene.points.size());
      for (std::size_t i = 0; i < colours.size(); ++i) {
        const auto expected = colour(scene.points[i], scene.view, scene.camera, sectors);
        expectSame(colours[i].by(scene.view.frame.stamp), expected);
        const NoColour* reason = std::get_if<NoColour>(&expected);
        ++(reason == nullptr                    ? tally.coloured
           : *reason == NoColour::outside_image ? tally.outside
           : *reason == NoColour::hidden        ? tally.hidden
                                                : tally.unknown);
      }
    }
  }
  EXPECT_GT(tally.coloured, 1000);
  EXPECT_GT(tally.outside, 1000);
  EXPECT_GT(tally.hidden, 300);
  EXPECT_GT(tally.unknown, 100);
}

TEST_P(EveryLensInABatch, SamplesABatchAsItSamplesItsPoints) {
  const RandomScene scene(GetParam(), 6);  // as the image has them: a scene without air
  std::vector<Eigen::Vector3d> positions;
  for (const PlacedReturn& point : scene.points) positions.push_back(point.p_world);
  for (const CpuLevel level : levels()) {
    ColouringBatch batch(level);
    const auto celsius = batch.sample(positions, scene.view);
    ASSERT_EQ(celsius.size(), positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const auto expected = colour(scene.points[i], scene.view, scene.camera, NoOccluder());
      const Colour* found = std::get_if<Colour>(&expected);
      ASSERT_EQ(std::isnan(celsius[i]), found == nullptr);
      if (found != nullptr) {
        EXPECT_EQ(celsius[i], found->celsius);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ColouringBatch, EveryLensInABatch, testing::ValuesIn(test::kLenses),
                         [](const auto& info) { return info.param.name; });

TEST(ColouringBatch, TakesThePointsThatAreListed) {
  const RandomScene scene(test::kLenses[2], 3);
  const NoOccluder nothing;
  ColouringBatch all, some;
  const auto of_all = all.colour(scene.points, {scene.view, scene.camera, nothing});
  std::vector<std::uint32_t> which;
  for (std::uint32_t i = 5; i < scene.points.size(); i += 3) which.push_back(i);
  std::reverse(which.begin(), which.end());
  const auto of_some = some.colour(scene.points, which, {scene.view, scene.camera, nothing});
  ASSERT_EQ(of_some.size(), which.size());
  for (std::size_t i = 0; i < which.size(); ++i)
    expectSame(of_some[i].by(Time()), of_all[which[i]].by(Time()));
}

TEST(ColouringBatch, TakesAnyNumberOfPoints) {
  const RandomScene scene(test::kLenses[2], 4);
  const NoOccluder nothing;
  ColouringBatch batch;
  for (std::size_t count = 0; count < 300; ++count) {
    const std::span<const PlacedReturn> points(scene.points.data(), count);
    const auto colours = batch.colour(points, {scene.view, scene.camera, nothing});
    ASSERT_EQ(colours.size(), count);
    for (std::size_t i = 0; i < count; ++i)
      expectSame(colours[i].by(Time()), colour(points[i], scene.view, scene.camera, nothing));
  }
}

TEST(ColouringBatch, AsksAnOccluderThatKnowsOnlySingleSights) {
  struct Curtain final : Occluder {
    [[nodiscard]] bool hides(const Sight& sight) const override {
      return (sight.p_world - sight.camera_world).norm() + 0.01 * sight.pixel.x() > 6.0 + 0.1 * sight.depth;
    }
  };
  const RandomScene scene(test::kLenses[2], 5);
  const Curtain curtain;
  ColouringBatch batch;
  const auto colours = batch.colour(scene.points, {scene.view, scene.camera, curtain});
  for (std::size_t i = 0; i < colours.size(); ++i)
    expectSame(colours[i].by(Time()), colour(scene.points[i], scene.view, scene.camera, curtain));
}

}  // namespace
}  // namespace thermovox
