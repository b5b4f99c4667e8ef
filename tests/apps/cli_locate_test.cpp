#include <cmath>

#include "tests/apps/program.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/io/tiff_writer.hpp"

namespace thermovox::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using Json = nlohmann::json;

constexpr const char* kCamera = R"(thermal_camera:
  width: 40
  height: 30
  model: pinhole
  fx: 50
  fy: 50
  cx: 19.5
  cy: 14.5
  netd: 0.1
  bias_sigma: 2.0
  T_body_camera: {translation: [0, 0, 0], quaternion_xyzw: [-0.5, 0.5, -0.5, 0.5]}
)";
constexpr const char* kBeam = R"(laser:
  kind: beam
  T_body_laser: {translation: [0.1, 0.05, 0], quaternion_xyzw: [0, 0, 0, 1]}
  range_min: 0.1
  range_max: 40
  range_sigma: 0.008
  range_bias_sigma: 0.004
)";

/// A body that looks along its x, with a frame of two hot places.
class LocateVerb : public testing::Test {
 protected:
  LocateVerb() {
    folder.write("rig.yaml", std::string(kCamera) + kBeam);
    std::vector<float> celsius(40 * 30, 20.0F);
    for (int i = 0; i < 16; ++i) celsius[static_cast<std::size_t>((8 + i / 4) * 40 + 6 + i % 4)] = 60.0F;
    celsius[20 * 40 + 30] = 80.0F;
    writeTiff(folder / "a.tiff", TiffPages<float>{40, 30, {celsius}});
  }
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return thermovox(folder.path(), "locate " + arguments);
  }
  [[nodiscard]] Json blobs(const std::string& arguments) const {
    const Outcome outcome = run(arguments + " --json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.json().at("blobs");
  }
  static void expectNear(const Json& found, const std::vector<double>& expected, double tolerance = 1e-6) {
    ASSERT_EQ(found.size(), expected.size()) << found;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(found[i].get<double>(), expected[i], tolerance) << found;
    }
  }

  TestFolder folder;
  const std::string usual = "a.tiff --rig rig.yaml --range 3.9 --above 40 ";
};

TEST_F(LocateVerb, SaysWhereInCameraBodyAndWorld) {
  const Json hot = blobs(usual + "--pose '10 20 2 0 0 0.70710678118 0.70710678118'");
  ASSERT_THAT(hot, SizeIs(2));
  EXPECT_EQ(hot[0]["peak"], 80.0);
  EXPECT_EQ(hot[0]["pixels"], 1);
  EXPECT_TRUE(hot[0]["reads_low"]);
  EXPECT_FALSE(hot[1]["reads_low"]);
  const Json& blob =
      hot[1];  // about the pixel (7.5, 9.5), 4 m ahead: the beam starts 0.1 m before the camera
  expectNear(blob["pixel"], {7.5, 9.5});
  expectNear(blob["position_camera"], {-0.96, -0.4, 4.0});
  expectNear(blob["position_body"], {4.0, 0.96, 0.4});
  expectNear(blob["position"], {9.04, 24.0, 2.4});
  EXPECT_NEAR(blob["area"].get<double>(), 16 * 0.0064, 1e-6);
  EXPECT_EQ(blob["mean"], 60.0);
  EXPECT_NEAR(blob["noise_sigma"].get<double>(), 0.1, 1e-9);
  EXPECT_EQ(blob["bias_sigma"], 2.0);
  EXPECT_NEAR(blob["peak_sigma"].get<double>(), std::hypot(0.1, 2.0), 1e-9);
  // Along the beam, the world's y: range noise and bias. Sideways the ray (0.24 of the depth) takes its
  // share.
  EXPECT_NEAR(blob["covariance"][1][1].get<double>(), 80e-6, 1e-9);
  EXPECT_NEAR(blob["covariance_common_body"][0][0].get<double>(), 16e-6, 1e-9);
  EXPECT_GT(blob["covariance"][0][0].get<double>(), 80e-6 * 0.24 * 0.24);
}

TEST_F(LocateVerb, CallsItselfAnApproximation) {
  const Json json = run(usual + "--json").json();
  EXPECT_THAT(json["approximation"].get<std::string>(), HasSubstr("one distance stands for the whole frame"));
  expectNear(json["plane"]["point_body"], {4.0, 0.05, 0.0});
  expectNear(json["plane"]["normal_body"], {1.0, 0.0, 0.0});
  EXPECT_TRUE(json["pose"].is_null());
  EXPECT_TRUE(json["blobs"][0]["position"].is_null());  // no pose
  const Outcome text = run(usual);
  EXPECT_THAT(text.out, HasSubstr("approximation: "));
  EXPECT_THAT(text.out, HasSubstr("80.0<"));
}

TEST_F(LocateVerb, TakesTheSurfacesNormal) {
  const Json blob = blobs(usual + "--normal 1 0 1").at(1);
  // x + z = 4 meets the ray (1, 0.24, 0.1).
  expectNear(blob["position_body"], {4.0 / 1.1, 0.24 * 4.0 / 1.1, 0.4 / 1.1});
  // The same direction in the world, in which the body's x is y.
  const Json turned = blobs(usual + "--normal 0 1 1 --pose '0 0 0 0 0 0.70710678118 0.70710678118'").at(1);
  expectNear(turned["position_body"], {4.0 / 1.1, 0.24 * 4.0 / 1.1, 0.4 / 1.1});
  EXPECT_TRUE(blobs(usual + "--normal 0 0 1").at(1)["position_body"].is_null());  // nearly edge on
}

TEST_F(LocateVerb, FindsNothingAndSaysSo) {
  const Outcome outcome = run("a.tiff --rig rig.yaml --range 3.9 --above 90");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "nothing in a.tiff is 90 C or hotter\n");
  EXPECT_THAT(blobs("a.tiff --rig rig.yaml --range 3.9 --above 90"), SizeIs(0));
}

TEST_F(LocateVerb, TakesTheBeamsRangeForTheDistanceOfRadiometricFrames) {
  const FlirFile frame{.width = 40, .height = 30, .counts = calmCounts(40, 30), .parameters = e40()};
  folder.write("f.jpg", radiometricJpeg(flirFrame(frame)));
  RadiometricParameters far = e40();
  far.distance = 30.0;
  far.humidity = 0.9;
  const double hottest = celsiusOfCounts(*std::max_element(frame.counts.begin(), frame.counts.end()), far);
  const Json hot = blobs("f.jpg --rig rig.yaml --range 30 --above -50 --humidity 0.9");
  ASSERT_THAT(hot, SizeIs(1));
  EXPECT_NEAR(hot[0]["peak"].get<double>(), hottest, 1e-3);
}

TEST_F(LocateVerb, TakesCountsByTheRigOrTheOption) {
  writeTiff(folder / "c.tiff", TiffPages<std::uint16_t>{40, 30, {std::vector<std::uint16_t>(1200, 30000)}});
  const Json hot = blobs("c.tiff --rig rig.yaml --range 3.9 --above 20 --celsius-per-count 0.01");
  EXPECT_NEAR(hot.at(0)["peak"].get<double>(), 26.85, 1e-3);
  expectRefused(folder.path(), "locate " + usual + "--celsius-per-count 0.01",
                {"a.tiff", "expected a TIFF of counts"});
}

TEST_F(LocateVerb, RefusesWhatItCannotUse) {
  folder.write("blind.yaml", kBeam);
  folder.write("dark.yaml", kCamera);
  folder.write("scan.yaml", std::string(kCamera) +
                                "laser:\n  kind: cloud\n  T_body_laser: {translation: [0, 0, 0], "
                                "quaternion_xyzw: [0, 0, 0, 1]}\n  range_min: 0.1\n  range_max: 40\n"
                                "  range_sigma: 0.01\n");
  const std::string rest = " --range 3.9 --above 40";
  expectRefused(folder.path(), "locate a.tiff --rig blind.yaml" + rest, {"blind.yaml", "no thermal_camera"});
  expectRefused(folder.path(), "locate a.tiff --rig dark.yaml" + rest,
                {"dark.yaml", "no lasers of kind beam"});
  expectRefused(folder.path(), "locate a.tiff --rig scan.yaml" + rest,
                {"scan.yaml", "no lasers of kind beam"});
  expectRefused(folder.path(), "locate a.tiff --rig rig.yaml --range 41 --above 40",
                {"the range is 41 m", "0.1 to 40 m"});
  writeTiff(folder / "small.tiff", TiffPages<float>{4, 3, {std::vector<float>(12, 50.0F)}});
  expectRefused(folder.path(), "locate small.tiff --rig rig.yaml" + rest,
                {"small.tiff", "4 x 3 pixels, expected 40 x 30"});
  expectRefused(folder.path(), "locate none.tiff --rig rig.yaml" + rest, {"none.tiff", "no such file"});
}

TEST_F(LocateVerb, RefusesWrongUsage) {
  for (const char* wrong :
       {"--pose '1 2 3'", "--normal 0 0 0", "--normal 1 2", "--above nan", "--emissivity 3", "--frame -1"}) {
    SCOPED_TRACE(wrong);
    EXPECT_EQ(run(usual + wrong).code, 2);
  }
  EXPECT_EQ(run("a.tiff --rig rig.yaml --above 40").code, 2);
}

}  // namespace
}  // namespace thermovox::test
