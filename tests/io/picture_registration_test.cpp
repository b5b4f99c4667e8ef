#include "io/picture_registration.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "apps/simulate/simulated_rig.hpp"
#include "io/rig_file.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::HasSubstr;

std::string greyJpeg(int width, int height) {
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", cv::Mat(height, width, CV_8U, cv::Scalar(90)), jpeg);
  return {jpeg.begin(), jpeg.end()};
}

/// A rig with both cameras, and a picture of the visible one.
class RegisterByRig : public testing::Test {
 protected:
  RegisterByRig() {
    simulate::SimulationOptions options;
    options.visible = simulate::SimulationOptions::VisibleCamera::present;
    rig = simulate::makeRig(options);
    writeRig(folder / "rig.yaml", rig);
    rig = readRig(folder / "rig.yaml");
    thermal.width = rig.thermal_camera->camera.width();
    thermal.height = rig.thermal_camera->camera.height();
    folder.write("visible.jpg",
                 greyJpeg(rig.visible_camera->camera.width(), rig.visible_camera->camera.height()));
  }
  [[nodiscard]] PictureByRig at(double range) const {
    return {folder / "visible.jpg", folder / "rig.yaml", range};
  }
  [[nodiscard]] std::string complaint(const PictureByRig& by) const {
    return messageOf<Error>([&] { static_cast<void>(registerByRig(by, thermal, "a.tiff")); });
  }

  test::TestFolder folder;
  Rig rig;
  RawThermalImage thermal;
};

TEST_F(RegisterByRig, PutsEveryPixelWhereTheVisibleCameraSeesItsSurface) {
  const MountedCamera& visible = *rig.visible_camera;
  const Pose T_visible_thermal = visible.T_body_camera.inverse() * rig.thermal_camera->T_body_camera;
  for (const double range : {2.0, 20.0}) {
    const RegisteredPicture registered = registerByRig(at(range), thermal, "a.tiff");
    EXPECT_EQ(registered.picture.width, visible.camera.width());
    ASSERT_EQ(registered.pixels.pixels.size(), static_cast<std::size_t>(thermal.width * thermal.height));
    for (const auto& [u, v] : {std::pair{10, 20}, {80, 60}, {150, 100}}) {
      const auto ray = rig.thermal_camera->camera.rayFromPixel(Eigen::Vector2d(u, v));
      ASSERT_TRUE(ray);
      const Eigen::Vector3d surface = *ray * (range / ray->z());
      const auto expected = visible.camera.project(T_visible_thermal * surface);
      ASSERT_TRUE(expected) << u << ", " << v;
      const auto place = static_cast<std::size_t>(v * thermal.width + u);
      EXPECT_LT((registered.pixels.pixels[place] - *expected).norm(), 1e-6) << u << ", " << v;
    }
  }
}

TEST_F(RegisterByRig, NeedsARigWithBothCamerasOfTheseSizes) {
  Rig part = rig;
  part.visible_camera.reset();
  writeRig(folder / "thermal.yaml", part);
  part = rig;
  part.thermal_camera.reset();
  writeRig(folder / "visible.yaml", part);
  PictureByRig by = at(3.0);
  by.rig = folder / "thermal.yaml";
  EXPECT_THAT(complaint(by), HasSubstr("thermal.yaml: has no visible_camera"));
  by.rig = folder / "visible.yaml";
  EXPECT_THAT(complaint(by), HasSubstr("visible.yaml: has no thermal_camera"));
  by = at(3.0);
  by.visible = folder.write("small.jpg", greyJpeg(60, 40));
  EXPECT_THAT(complaint(by), HasSubstr("small.jpg: is 60 x 40"));
  ++thermal.width;
  EXPECT_THAT(complaint(at(3.0)), HasSubstr("a.tiff: is " + std::to_string(thermal.width) + " x"));
}

TEST_F(RegisterByRig, RefusesPicturesThatShowNothingOfTheThermalImage) {
  EXPECT_THAT(complaint(at(0.02)), HasSubstr("a.tiff: no pixel of it lies in the visible picture"));
  EXPECT_THAT(complaint(at(std::numeric_limits<double>::quiet_NaN())), HasSubstr("no pixel of it"));
}

/// A FLIR file's image of 40 x 30 with a visible picture of 320 x 240.
RawThermalImage withPicture(const PictureInPicture& record) {
  RawThermalImage thermal{.width = 40, .height = 30};
  const std::string jpeg = greyJpeg(320, 240);
  const auto bytes = std::as_bytes(std::span(jpeg));
  thermal.metadata.visible =
      EmbeddedPicture{EmbeddedPicture::Encoding::jpeg, 320, 240, {bytes.begin(), bytes.end()}};
  thermal.metadata.picture_in_picture = record;
  return thermal;
}

std::string complaintAbout(const RawThermalImage& thermal) {
  return messageOf<DataError>([&] { static_cast<void>(registerByRecord(thermal, "a.jpg")); });
}

TEST(RegisterByRecord, LaysTheThermalImageWhereTheFileSays) {
  const RegisteredPicture registered =
      registerByRecord(withPicture({.real_to_ir = 2.0, .offset_x = 10, .offset_y = -5}), "a.jpg");
  EXPECT_EQ(registered.picture.width, 320);
  // 160 visible pixels wide, four for a thermal one, about (159.5 + 10, 119.5 - 5).
  EXPECT_NEAR(registered.pixels.pixels.front().x(), 169.5 - 4.0 * 19.5, 1e-9);
  EXPECT_NEAR(registered.pixels.pixels.front().y(), 114.5 - 4.0 * 14.5, 1e-9);
}

TEST(RegisterByRecord, NamesWhatAFileLacks) {
  RawThermalImage thermal = withPicture({});
  thermal.metadata.picture_in_picture.reset();
  EXPECT_THAT(complaintAbout(thermal), HasSubstr("a.jpg: holds no record of where its visible picture lies"));
  thermal.metadata.visible.reset();
  EXPECT_THAT(complaintAbout(thermal), HasSubstr("a.jpg: holds no visible picture"));
}

TEST(RegisterByRecord, RefusesARecordThatCannotBe) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double ratio : {0.0, -1.0, infinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT(complaintAbout(withPicture({.real_to_ir = ratio})), HasSubstr("expected a positive number"));
  EXPECT_THAT(complaintAbout(withPicture({.real_to_ir = 2.0, .offset_x = 30000})),
              HasSubstr("no pixel of it lies in the visible picture"));
}

}  // namespace
}  // namespace thermovox
