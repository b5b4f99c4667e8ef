// A reading coloured at once against its returns coloured one after the other.
#include "mapping/frame_window.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "projection/depth_sectors.hpp"
#include "tests/mapping/synthetic_mission.hpp"

namespace thermovox {
namespace {

using Answer = std::variant<FrameColour, Uncoloured>;

/// Frames of a camera that turns, some without a pose, some that nobody wanted, one still open.
struct Window {
  ThermalCamera camera{.camera = test::wideCamera()};
  FrameWindow window{camera, {.limit = std::chrono::milliseconds(450), .lookahead = {}}};

  Window() {
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(20.0, 5.0);
    for (int i = 0; i < 12; ++i) {
      const double stamp = 10.0 + 0.2 * i;
      const ThermalFrame frame = test::frameOf(
          test::imageOf(64, 48, [&](int u, int) { return u == 20 ? std::nan("") : noise(random); }),
          test::at(stamp));
      const Pose T_world_camera{expRotation({0.0, 0.12 * i, 0.0}), {0.05 * i, 0.0, 0.0}};
      window.add(frame, i % 5 == 3 ? std::nullopt : std::optional(T_world_camera));
    }
    for (int i = 0; i < 11; ++i) {
      if (i == 6) {
        window.closeNext(nullptr);
      } else {
        window.closeNext([this](const ThermalView& view) { return plateBefore(view); });
      }
    }
  }

  [[nodiscard]] std::unique_ptr<Occluder> plateBefore(const ThermalView& view) const {
    auto depths = std::make_unique<DepthSectors>(camera.camera, view.T_camera_world, DepthSectors::Options());
    for (double x = -0.5; x < 0.5; x += 0.03) {
      for (double y = -0.5; y < 0.5; y += 0.03) depths->add(Eigen::Vector3d(x, y, 3.0));
    }
    depths->finish();
    return depths;
  }
};

std::vector<PlacedReturn> randomReading(std::mt19937_64& random, int returns) {
  std::uniform_real_distribution<double> aside(-4.0, 4.0), ahead(2.0, 6.0), time(9.3, 12.9);
  std::vector<PlacedReturn> reading;
  double stamp = time(random);
  for (int i = 0; i < returns; ++i) {
    if (i % 7 == 0) stamp = time(random);
    reading.push_back({.stamp = test::at(stamp + 1e-4 * i),
                       .p_world = {aside(random), 0.6 * aside(random), ahead(random)},
                       .origin_world = Eigen::Vector3d::Zero(),
                       .range = 1.0,
                       .rig_covariance = 1e-4 * Eigen::Matrix3d::Identity(),
                       .pose_covariance = Eigen::Matrix3d::Zero()});
  }
  return reading;
}

void expectSame(const Answer& found, const Answer& expected) {
  ASSERT_EQ(found.index(), expected.index());
  if (const Uncoloured* reason = std::get_if<Uncoloured>(&expected)) {
    EXPECT_EQ(std::get<Uncoloured>(found), *reason);
    return;
  }
  const FrameColour& a = std::get<FrameColour>(found);
  const FrameColour& b = std::get<FrameColour>(expected);
  EXPECT_EQ(a.sample, b.sample);
  EXPECT_EQ(a.colour.frame_stamp, b.colour.frame_stamp);
  EXPECT_EQ(a.colour.pixel, b.colour.pixel);
  EXPECT_EQ(a.colour.celsius, b.colour.celsius);
  EXPECT_EQ(a.colour.sigma, b.colour.sigma);
  EXPECT_EQ(a.colour.range, b.colour.range);
}

TEST(FrameWindow, ColoursAReadingAsItsReturnsOneAfterTheOther) {
  std::mt19937_64 random(6);
  Window at_once, one_by_one;
  std::set<Uncoloured> reasons;
  int coloured = 0, shared_pixels = 0, by_another = 0;
  for (const int returns : {0, 1, 5, 400, 3000}) {
    const std::vector<PlacedReturn> reading = randomReading(random, returns);
    const auto answers = at_once.window.colour(reading);
    ASSERT_EQ(answers.size(), reading.size());
    for (std::size_t i = 0; i < reading.size(); ++i) {
      const Answer expected = one_by_one.window.colour(reading[i]);
      expectSame(answers[i], expected);
      if (const Uncoloured* reason = std::get_if<Uncoloured>(&expected)) {
        reasons.insert(*reason);
        continue;
      }
      const FrameColour& found = std::get<FrameColour>(expected);
      ++coloured;
      shared_pixels += found.sample > 1 ? 1 : 0;
      const Duration away = found.colour.frame_stamp - reading[i].stamp;
      by_another += away > std::chrono::milliseconds(101) || away < -std::chrono::milliseconds(101) ? 1 : 0;
    }
  }
  EXPECT_GT(coloured, 500);
  EXPECT_GT(shared_pixels, 20);
  EXPECT_GT(by_another, 50);
  EXPECT_EQ(reasons, (std::set{Uncoloured::no_frame, Uncoloured::no_pose_for_frame, Uncoloured::outside_image,
                               Uncoloured::hidden, Uncoloured::unknown_pixel}));
}

}  // namespace
}  // namespace thermovox
