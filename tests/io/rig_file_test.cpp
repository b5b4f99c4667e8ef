#include "io/rig_file.hpp"

#include <gmock/gmock.h>

#include <random>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view kThermal = R"(thermal_camera:
  width: 160
  height: 120
  model: brown_conrady
  fx: 152.3
  fy: 151.6
  cx: 78.9
  cy: 61.2
  distortion: [-0.21, 0.07, 0.0012, -0.0008, 0.0]
  celsius_per_count: 0.01
  celsius_offset: -273.15
  T_body_camera: {translation: [0.1, -0.02, 0.3], quaternion_xyzw: [-0.5, 0.5, -0.5, 0.5]}
)";
constexpr std::string_view kBeam = R"(laser:
  kind: beam
  range_min: 0.05
  range_max: 40
  range_sigma: 0.01
  T_body_laser: {translation: [1, 2, 3], quaternion_xyzw: [0, 0, 0, 1]}
)";

std::string text() {
  return std::string(kThermal) + std::string(kBeam);
}

std::string with(std::string_view old_part, std::string_view new_part) {
  std::string rig = text();
  const std::size_t place = rig.find(old_part);
  EXPECT_NE(place, std::string::npos) << old_part;
  return rig.replace(place, old_part.size(), new_part);
}

Rig parse(const std::string& rig) {
  return parseRig(rig, "rig.yaml");
}

std::string complaintAbout(const std::string& rig) {
  return messageOf<ConfigError>([&] { static_cast<void>(parse(rig)); });
}

std::string identity36() {
  std::string numbers;
  for (int i = 0; i < 36; ++i) numbers += std::string(i == 0 ? "" : ", ") + (i % 7 == 0 ? "1e-6" : "0");
  return "[" + numbers + "]";
}

void expectSamePose(const Pose& a, const Pose& b) {
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
}

void expectSameIntrinsics(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.width(), b.width());
  EXPECT_EQ(a.height(), b.height());
  EXPECT_EQ(a.intrinsics().model, b.intrinsics().model);
  EXPECT_EQ(a.intrinsics().parameters, b.intrinsics().parameters);
  EXPECT_EQ(a.intrinsics().distortion_count, b.intrinsics().distortion_count);
}

TEST(ReadRig, ReadsCameraAndLaser) {
  const Rig rig = parse(text());
  ASSERT_TRUE(rig.thermal_camera);
  const Intrinsics& in = rig.thermal_camera->camera.intrinsics();
  EXPECT_EQ(in.width_px, 160);
  EXPECT_EQ(in.height_px, 120);
  EXPECT_EQ(in.parameters[kFx], 152.3);
  EXPECT_EQ(in.parameters[kCy], 61.2);
  EXPECT_EQ(in.parameters[kDistortion + 3], -0.0008);
  EXPECT_EQ(in.distortion_count, 5);
  EXPECT_EQ(rig.thermal_camera->T_body_camera.translation, Eigen::Vector3d(0.1, -0.02, 0.3));
  EXPECT_EQ(rig.thermal_camera->T_body_camera.rotation.coeffs(), Eigen::Vector4d(-0.5, 0.5, -0.5, 0.5));
  EXPECT_FALSE(rig.visible_camera);
  ASSERT_EQ(rig.lasers.size(), 1U);
  EXPECT_EQ(rig.lasers[0].kind, LaserKind::beam);
  EXPECT_EQ(rig.lasers[0].range_max, 40.0);
  EXPECT_TRUE(rig.lasers[0].covariance_body_laser.isZero(0.0));
}

TEST(ReadRig, ReadsTheScaleOfTheCountsOrLeavesItToTheImages) {
  const Rig rig = parse(text());
  ASSERT_TRUE(rig.thermal_camera->t_linear);
  EXPECT_EQ(rig.thermal_camera->t_linear->celsius_per_count, 0.01);
  EXPECT_EQ(rig.thermal_camera->t_linear->celsius_offset, -273.15);
  const std::string per_count = "  celsius_per_count: 0.01\n", offset = "  celsius_offset: -273.15\n";
  const Rig silent = parse(with(per_count + offset, ""));
  EXPECT_FALSE(silent.thermal_camera->t_linear);
  EXPECT_FALSE(parse(rigText(silent)).thermal_camera->t_linear);
  EXPECT_EQ(complaintAbout(with(offset, "")), "rig.yaml, thermal_camera.celsius_offset: is missing");
  EXPECT_EQ(complaintAbout(with(per_count, "")), "rig.yaml, thermal_camera.celsius_per_count: is missing");
  EXPECT_THAT(complaintAbout(with(per_count, "  celsius_per_count: 0\n")), HasSubstr("expected more than 0"));
}

TEST(ReadRig, ReadsLasersAsAList) {
  const Rig rig = parse(R"(
laser:
  - {kind: cloud, range_min: 0, range_max: 9, range_sigma: 0.02, min_intensity: 7,
     T_body_laser: {translation: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}}
  - {kind: scan, angle_min: -1.5, angle_increment: 0.01, time_increment: 1.736e-5, range_min: 0.1, range_max: 9,
     range_sigma: 0.02, range_bias_sigma: 0.03,
     T_body_laser: {translation: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}}
)");
  ASSERT_EQ(rig.lasers.size(), 2U);
  EXPECT_EQ(rig.lasers[0].kind, LaserKind::cloud);
  EXPECT_EQ(rig.lasers[0].min_intensity, 7.0);
  EXPECT_EQ(rig.lasers[1].min_intensity, -std::numeric_limits<double>::infinity());  // nothing is too weak
  EXPECT_EQ(rig.lasers[1].time_increment.count(), 17360);
  EXPECT_EQ(rig.lasers[1].range_bias_sigma, 0.03);
  EXPECT_FALSE(rig.thermal_camera);
}

TEST(ReadRig, TakesTheTransposedMatrixOfMatlab) {
  const std::string four = "  fx: 152.3\n  fy: 151.6\n  cx: 78.9\n  cy: 61.2\n";
  const Rig flat = parse(with(four, "  K_matlab: [152.3, 0, 0, 0, 151.6, 0, 78.9, 61.2, 1]\n"));
  const Rig rows = parse(with(four, "  K_matlab: [[152.3, 0, 0], [0, 151.6, 0], [78.9, 61.2, 1]]\n"));
  expectSameIntrinsics(flat.thermal_camera->camera, parse(text()).thermal_camera->camera);
  expectSameIntrinsics(rows.thermal_camera->camera, flat.thermal_camera->camera);
  EXPECT_THAT(complaintAbout(with(four, "  K_matlab: [152.3, 0, 78.9, 0, 151.6, 61.2, 0, 0, 1]\n")),
              HasSubstr("rig.yaml, thermal_camera.K_matlab: is not of the form [fx 0 0; 0 fy 0; cx cy 1]"));
  EXPECT_THAT(complaintAbout(
                  with("  fx: 152.3\n", "  fx: 1\n  K_matlab: [152.3, 0, 0, 0, 151.6, 0, 78.9, 61.2, 1]\n")),
              HasSubstr("given beside K_matlab"));
}

TEST(ReadRig, NormalisesARoundedQuaternionAndRefusesOthers) {
  const Rig rig = parse(with("[0, 0, 0, 1]", "[0, 0, 0, 1.009]"));
  EXPECT_EQ(rig.lasers[0].T_body_laser.rotation.w(), 1.0);
  EXPECT_THAT(
      complaintAbout(with("[0, 0, 0, 1]", "[0, 0, 0, 1.011]")),
      AllOf(HasSubstr("rig.yaml, laser.T_body_laser.quaternion_xyzw"), HasSubstr("expected 1 within 1 %")));
}

TEST(ReadRig, NamesFileAndKeyOfWhatIsWrong) {
  EXPECT_EQ(complaintAbout(with("  fx: 152.3\n", "")), "rig.yaml, thermal_camera.fx: is missing");
  EXPECT_EQ(complaintAbout(with("fx: 152.3", "fx: .nan")),
            "rig.yaml, thermal_camera.fx: found '.nan', expected a finite number");
  EXPECT_EQ(complaintAbout(with("fx: 152.3", "fx: nan")),
            "rig.yaml, thermal_camera.fx: found 'nan', expected a finite number");
  EXPECT_EQ(complaintAbout(with("kind: beam", "kind: sonar")),
            "rig.yaml, laser.kind: found 'sonar', expected beam, scan or cloud");
  EXPECT_EQ(complaintAbout(with("width: 160", "width: 160.5")),
            "rig.yaml, thermal_camera.width: found '160.5', expected a whole number");
  EXPECT_THAT(complaintAbout(with("range_max: 40", "range_max: 0.01")),
              HasSubstr("laser.range_max: the ranges go"));
  EXPECT_THAT(complaintAbout(with("range_sigma: 0.01", "range_sigma: -1")),
              HasSubstr("laser.range_sigma: is -1"));
  EXPECT_THAT(complaintAbout(with("  range_sigma: 0.01\n", "")), HasSubstr("laser.range_sigma: is missing"));
  EXPECT_THAT(complaintAbout(with("[1, 2, 3]", "[1, 2]")),
              HasSubstr("laser.T_body_laser.translation: has 2 numbers, expected 3"));
  EXPECT_THAT(complaintAbout(with("fx: 152.3", "fx: -3")),
              HasSubstr("rig.yaml, thermal_camera: camera: fx and fy"));
  EXPECT_THAT(complaintAbout(with("[-0.21, 0.07, 0.0012, -0.0008, 0.0]", "[1, 2, 3]")),
              HasSubstr("thermal_camera: camera: 3 distortion coefficients"));
}

TEST(ReadRig, NamesAnUnknownKeyAndTheKnownOnes) {
  EXPECT_THAT(complaintAbout(with("range_sigma: 0.01", "range_sigma: 0.01\n  range_sgima: 1")),
              AllOf(HasSubstr("rig.yaml, laser: unknown key 'range_sgima'"), HasSubstr("range_bias_sigma")));
  EXPECT_THAT(complaintAbout("lasr: {}\n"),
              HasSubstr("rig.yaml: unknown key 'lasr', expected one of: thermal_camera"));
  EXPECT_THAT(complaintAbout(with("fx: 152.3", "fx: 152.3\n  fx: 99")), HasSubstr("fx: is given twice"));
}

TEST(ReadRig, RefusesWhatIsNoRig) {
  EXPECT_THAT(complaintAbout("{"), HasSubstr("rig.yaml:"));
  EXPECT_THAT(complaintAbout("- a\n"), HasSubstr("found a list, expected a mapping"));
  EXPECT_THAT(complaintAbout(""), HasSubstr("found nothing, expected a mapping"));
  EXPECT_THAT(complaintAbout("laser: 7\n"), HasSubstr("rig.yaml, laser: found '7', expected a mapping"));
  EXPECT_THAT(complaintAbout(text().substr(0, text().size() - 30)), HasSubstr("rig.yaml:"));  // cut off
  EXPECT_THAT(complaintAbout(std::string(100000, '[')), HasSubstr("rig.yaml"));               // too deep
}

TEST(ReadRig, RefusesAMatrixThatIsNoCovariance) {
  const std::string good = identity36();
  EXPECT_EQ(parse(text() + "  covariance_body_laser: " + good + "\n").lasers[0].covariance_body_laser,
            Matrix6d(1e-6 * Matrix6d::Identity()));
  std::string bad = good;
  EXPECT_THAT(complaintAbout(text() + "  covariance_body_laser: " + bad.replace(1, 4, "-1e-6") + "\n"),
              HasSubstr("laser.covariance_body_laser: has a negative variance"));
  bad = good;
  EXPECT_THAT(complaintAbout(text() + "  covariance_body_laser: " + bad.replace(7, 1, "1e-6") + "\n"),
              HasSubstr("is not symmetric"));
  EXPECT_THAT(complaintAbout(with("fx: 152.3", "fx: 152.3\n  covariance_intrinsics: [1, 2]")),
              HasSubstr("covariance_intrinsics: has 2 numbers, expected 81"));
  // Symmetric with a positive diagonal, but a correlation of 2.
  std::string indefinite = "[1, 2, 0, 0, 0, 0, 2, 1";
  for (int i = 8; i < 36; ++i) indefinite += i % 7 == 0 ? ", 1" : ", 0";
  EXPECT_THAT(complaintAbout(text() + "  covariance_body_laser: " + indefinite + "]\n"),
              HasSubstr("negative eigenvalue"));
}

Matrix6d randomCovariance(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Matrix6d a = Matrix6d::NullaryExpr([&] { return 1e-3 * normal(random); });
  const Matrix6d square = a * a.transpose();
  return 0.5 * (square + square.transpose().eval());
}

TEST(WriteRig, GivesTheSameNumbersBack) {
  const test::TestFolder folder;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Rig rig = parse(text());
  rig.thermal_camera->T_body_camera.rotation = Eigen::Quaterniond(normal(random), 1, 2, 3).normalized();
  rig.thermal_camera->T_body_camera.translation.setConstant(1.0 / 3.0);
  rig.thermal_camera->netd = 0.03;
  rig.thermal_camera->bias_sigma = 5.0;
  rig.thermal_camera->blur_px = 0.7;
  rig.thermal_camera->covariance_intrinsics = Eigen::MatrixXd::Identity(9, 9) / 7.0;
  rig.visible_camera = MountedCamera{
      .camera =
          Camera({640, 480, LensModel::kannala_brandt, {500.1, 501, 320, 240, 0.1, 0.01, 0.001, 1e-4}, 4}),
      .T_body_camera = {},
      .covariance_body_camera = randomCovariance(random)};
  rig.lasers[0].covariance_body_laser = randomCovariance(random);
  Laser scan;
  scan.kind = LaserKind::scan;
  scan.time_increment = Duration(17361);
  scan.range_bias_sigma = 0.004;
  scan.min_intensity = 0.1;
  rig.lasers.push_back(scan);

  writeRig(folder / "rig.yaml", rig);
  const Rig back = readRig(folder / "rig.yaml");

  expectSameIntrinsics(back.thermal_camera->camera, rig.thermal_camera->camera);
  expectSamePose(back.thermal_camera->T_body_camera, rig.thermal_camera->T_body_camera);
  EXPECT_EQ(back.thermal_camera->netd, 0.03);
  EXPECT_EQ(back.thermal_camera->bias_sigma, 5.0);
  EXPECT_EQ(back.thermal_camera->blur_px, 0.7);
  EXPECT_EQ(back.thermal_camera->covariance_intrinsics, rig.thermal_camera->covariance_intrinsics);
  expectSameIntrinsics(back.visible_camera->camera, rig.visible_camera->camera);
  EXPECT_EQ(back.visible_camera->covariance_body_camera, rig.visible_camera->covariance_body_camera);
  ASSERT_EQ(back.lasers.size(), 2U);
  EXPECT_EQ(back.lasers[0].covariance_body_laser, rig.lasers[0].covariance_body_laser);
  expectSamePose(back.lasers[0].T_body_laser, rig.lasers[0].T_body_laser);
  EXPECT_EQ(back.lasers[1].kind, LaserKind::scan);
  EXPECT_EQ(back.lasers[1].angle_min, scan.angle_min);
  EXPECT_EQ(back.lasers[1].angle_increment, scan.angle_increment);
  EXPECT_EQ(back.lasers[1].time_increment, scan.time_increment);
  EXPECT_EQ(back.lasers[1].range_bias_sigma, scan.range_bias_sigma);
  EXPECT_EQ(back.lasers[1].min_intensity, scan.min_intensity);
  EXPECT_EQ(rigText(back), rigText(rig));
}

TEST(WriteRig, WritesARigWithoutSensors) {
  EXPECT_TRUE(parse(rigText(Rig{})).lasers.empty());
}

TEST(ReadRig, ReadsTheRecordings) {
  THERMOVOX_NEEDS_RECORDINGS();
  for (const char* folder : {"missions/hall-beam", "missions/hall-scan", "missions/hall-cloud",
                             "missions/intel", "missions/jhu-board", "captures/acfr", "captures/board-beam",
                             "captures/board-scan", "captures/board-cloud"}) {
    SCOPED_TRACE(folder);
    const Rig rig = readRig(*test::recordings() / folder / "rig.yaml");
    EXPECT_EQ(rig.lasers.size(), 1U);
    EXPECT_EQ(rigText(parse(rigText(rig))), rigText(rig));
  }
}

}  // namespace
}  // namespace thermovox
