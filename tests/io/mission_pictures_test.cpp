#include "io/mission_pictures.hpp"

#include <gtest/gtest.h>

#include "apps/simulate/mission_writer.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A mission with thermal frames and visible pictures, taken together.
class MissionPicturesTest : public testing::Test {
 protected:
  MissionPicturesTest() {
    simulate::SimulationOptions options;
    options.duration = 0.8;
    options.supersampling = 1;
    options.visible = simulate::SimulationOptions::VisibleCamera::present;
    simulate::simulateMission(options, folder / "hall");
    opened = openMission(folder / "hall");
  }
  [[nodiscard]] Pose poseAt(Time stamp) const { return std::get<Pose>(opened.mission.trajectory.at(stamp)); }
  /// A point that the thermal camera sees at a pixel, so many metres along its optical axis.
  [[nodiscard]] Eigen::Vector3d seenAt(Time stamp, const Eigen::Vector2d& pixel, double depth) const {
    const ThermalCamera& thermal = *opened.mission.rig.thermal_camera;
    const Eigen::Vector3d ray = thermal.camera.rayFromPixel(pixel).value();
    return poseAt(stamp) * (thermal.T_body_camera * (ray * (depth / ray.z())));
  }

  test::TestFolder folder;
  OpenedMission opened;
};

TEST_F(MissionPicturesTest, LieWhereTheVisibleCameraSeesTheLasersPoints) {
  MissionPictures pictures(opened, milliseconds(100));
  const MountedCamera& visible = *opened.mission.rig.visible_camera;
  const Time stamp = opened.frames->next()->stamp;
  const std::vector<Eigen::Vector2d> places{{40.0, 30.0}, {120.0, 90.0}};
  const std::vector<Eigen::Vector3d> points{seenAt(stamp, places[0], 3.0), seenAt(stamp, places[1], 9.0)};
  const auto registered = pictures.on(stamp, points);
  ASSERT_TRUE(registered);
  const Pose T_camera_world = (poseAt(stamp) * visible.T_body_camera).inverse();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto expected = visible.camera.project(T_camera_world * points[i]);
    ASSERT_TRUE(expected);
    EXPECT_LT((registered->pixels.at(places[i]) - *expected).norm(), 1e-3) << i;
  }
}

TEST_F(MissionPicturesTest, AreNoneWithoutAPictureNearInTime) {
  MissionPictures pictures(opened, milliseconds(20));
  const Time first = opened.frames->next()->stamp;
  EXPECT_TRUE(pictures.on(first, {}));
  EXPECT_FALSE(pictures.on(first + milliseconds(60), {}));
}

TEST_F(MissionPicturesTest, AreNoneWhereTheTrajectoryHasNoPose) {
  MissionPictures pictures(opened, seconds(1000));
  EXPECT_FALSE(pictures.on(opened.mission.trajectory.poses().back().stamp + seconds(100), {}));
}

TEST_F(MissionPicturesTest, NameThePictureThatIsNotThere) {
  std::filesystem::remove_all(folder / "hall/visible");
  MissionPictures pictures(opened, seconds(1));
  EXPECT_THROW(static_cast<void>(pictures.on(opened.frames->next()->stamp, {})), DataError);
}

}  // namespace
}  // namespace thermovox
