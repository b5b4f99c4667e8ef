#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/simulate/capture_laser.hpp"
#include "apps/simulate/capture_render.hpp"
#include "apps/simulate/capture_writer.hpp"
#include "apps/simulate/mission_writer.hpp"
#include "calibration/board_detector.hpp"
#include "io/point_cloud_file.hpp"
#include "io/rig_file.hpp"
#include "io/thermal_recording.hpp"
#include "io/visible_picture.hpp"
#include "projection/error.hpp"
#include "tests/apps/simulated_sweeps.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::simulate {
namespace {

namespace fs = std::filesystem;

CaptureOptions captureOptions(LaserKind laser, int captures = 3) {
  CaptureOptions options;
  options.laser = laser;
  options.captures = captures;
  options.seed = 5;
  return options;
}

/// The inner corners of the board of one capture as OUT.truth.json tells them, body frame.
std::vector<Eigen::Vector3d> cornersFrom(const nlohmann::json& board) {
  std::vector<Eigen::Vector3d> corners;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 9; ++column) {
      Eigen::Vector3d p_body;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = [&](std::size_t j) { return board.at("R").at(i).at(j).get<double>(); };
        p_body[static_cast<int>(i)] =
            board.at("t").at(i).get<double>() + 0.04 * (column * axis(0) + row * axis(1));
      }
      corners.push_back(p_body);
    }
  }
  return corners;
}

/// Root mean square of the distances, an axis, from the truth's corners to the nearest ones that were found:
/// which side of the board is the first one is not told by the pattern.
double cornerRms(const BoardImage& image, const Camera& camera, const Pose& T_body_camera,
                 const std::vector<Eigen::Vector3d>& corners) {
  const auto found = findChessboard(image, {9, 6});
  EXPECT_TRUE(found) << "no board";
  if (!found) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const Eigen::Vector3d& p_body : corners) {
    const auto pixel = camera.project(T_body_camera.inverse() * p_body);
    EXPECT_TRUE(pixel);
    double nearest = std::numeric_limits<double>::infinity();
    for (const BoardCorner& corner : *found)
      nearest = std::min(nearest, (corner.pixel - pixel.value_or(Eigen::Vector2d::Zero())).squaredNorm());
    sum += nearest;
  }
  return std::sqrt(sum / (2.0 * static_cast<double>(corners.size())));
}

BoardImage thermalImage(const fs::path& file) {
  const RawThermalImage raw = openThermalRecording(file)->read(0);
  BoardImage image{raw.width, raw.height, {}};
  image.values.assign(raw.counts.begin(), raw.counts.end());
  return image;
}

BoardImage visibleImage(const fs::path& file) {
  const VisiblePicture picture = readVisiblePicture(file);
  BoardImage image{picture.width, picture.height, {}};
  image.values.assign(picture.luminance.begin(), picture.luminance.end());
  return image;
}

/// Root mean square distance of the points that the plate alone can have returned to its plane as the truth
/// has it: points on it by their rays. -1 where there is none.
double planeRms(const CaptureScene& scene, std::size_t number) {
  const BoardCapture& capture = scene.captures().at(number);
  const Pose T_board_laser = capture.T_body_board.inverse() * scene.trueRig().lasers.front().T_body_laser;
  double sum = 0.0;
  int count = 0;
  for (const Reading& reading : measureCapture(scene, number)) {
    for (const LaserReturn& echo : reading.returns) {
      const auto range = scene.rangeOfPlate(capture, echo.p_laser.normalized());
      if (!range) continue;
      const double off = (T_board_laser * echo.p_laser).z();
      sum += off * off;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : -1.0;
}

TEST(SimulateCaptures, TruthIsWhereTheImagesShowTheBoard) {
  for (const LaserKind kind : kKinds) {
    const test::TestFolder folder;
    simulateCaptures(captureOptions(kind, 2), folder / "board");
    const auto truth = nlohmann::json::parse(test::bytesOf(folder / "board.truth.json"));
    const Rig rig = readRig(truthRigPath(folder / "board"));
    ASSERT_EQ(truth.size(), 2U);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      SCOPED_TRACE(i);
      const std::string number = "00" + std::to_string(i);
      const std::vector<Eigen::Vector3d> corners = cornersFrom(truth[i]);
      // Quantised and noisy corners of 5 to 12 px squares are found to a few hundredths of a pixel
      // (design study, 4.3); in the visible picture JPEG's blocks take part.
      EXPECT_LT(cornerRms(thermalImage(folder / ("board/" + number + "_thermal.tiff")),
                          rig.thermal_camera->camera, rig.thermal_camera->T_body_camera, corners),
                0.1);
      EXPECT_LT(cornerRms(visibleImage(folder / ("board/" + number + "_visible.jpg")),
                          rig.visible_camera->camera, rig.visible_camera->T_body_camera, corners),
                0.1);
      EXPECT_FALSE(truth[i].at("bad").get<bool>());
    }
  }
}

TEST(SimulateCaptures, TruthMeansWhatThatOfTheGivenCapturesMeans) {
  THERMOVOX_NEEDS_RECORDINGS();
  const fs::path captures = *test::recordings() / "captures";
  for (const std::string name : {"board-beam", "board-scan", "board-cloud"}) {
    const auto truth = nlohmann::json::parse(test::bytesOf(captures / (name + ".truth.json")));
    const ThermalCamera camera = *readRig(captures / (name + ".truth_rig.yaml")).thermal_camera;
    EXPECT_LT(cornerRms(thermalImage(captures / name / "000_thermal.tiff"), camera.camera,
                        camera.T_body_camera, cornersFrom(truth.at(0))),
              0.1);
  }
}

TEST(SimulateCaptures, LaserPointsLieOnTheBoardUnlessItMoved) {
  for (const LaserKind kind : kKinds) {
    CaptureOptions options = captureOptions(kind, 6);
    options.spoiled = 2;
    const CaptureScene scene(options);
    int spoiled = 0;
    for (std::size_t i = 0; i < scene.captures().size(); ++i) {
      SCOPED_TRACE(i);
      const double rms = planeRms(scene, i);
      if (scene.captures()[i].spoiled) {
        ++spoiled;
        EXPECT_GT(rms, 0.012);  // 2 cm along the laser's x, seen at up to 60 degrees
      } else {
        // The noise lies along the ray, the distance across the plane.
        EXPECT_GT(rms, 0.3 * options.range_sigma);
        EXPECT_LT(rms, 1.25 * options.range_sigma);  // of 100 readings of a beam
      }
    }
    EXPECT_EQ(spoiled, 2);
  }
}

TEST(SimulateCaptures, ABiasIsCommonToACapture) {
  CaptureOptions options = captureOptions(LaserKind::beam, 20);
  options.capture_bias_sigma = 0.05;
  const CaptureScene scene(options);
  double sum = 0.0;
  for (std::size_t i = 0; i < scene.captures().size(); ++i) {
    const std::vector<BeamReading> readings = measureBeam(scene, i);
    double mean = 0.0;
    for (const BeamReading& beam : readings) mean += beam.range / static_cast<double>(readings.size());
    const auto range = scene.rangeOfPlate(scene.captures()[i], Eigen::Vector3d::UnitX());
    ASSERT_TRUE(range);
    EXPECT_NEAR(mean - *range, scene.captures()[i].range_bias, 0.004);  // five sigmas of the mean
    sum += std::pow(scene.captures()[i].range_bias, 2);
  }
  EXPECT_NEAR(std::sqrt(sum / 20.0), 0.05, 0.025);  // three sigmas of 20 draws
}

TEST(SimulateCaptures, ABeamAtAnEdgeFallsOnBothSidesOfIt) {
  CaptureOptions options = captureOptions(LaserKind::beam, 2);
  options.edge_captures = 8;
  const CaptureScene scene(options);
  ASSERT_EQ(scene.captures().size(), 10U);
  for (std::size_t i = 2; i < 10; ++i) {
    SCOPED_TRACE(i);
    const BoardCapture& capture = scene.captures()[i];
    EXPECT_EQ(capture.edge, static_cast<BoardSide>((i - 2) % 4));
    const Pose T_board_laser = capture.T_body_board.inverse() * scene.trueRig().lasers.front().T_body_laser;
    int on_board = 0;
    for (const BeamReading& beam : measureBeam(scene, i)) {
      const Eigen::Vector3d p_board = T_board_laser * Eigen::Vector3d(beam.range, 0.0, 0.0);
      if (std::abs(p_board.z()) > 0.1) continue;
      ++on_board;
      const bool sideways = *capture.edge == BoardSide::left || *capture.edge == BoardSide::right;
      const bool first = *capture.edge == BoardSide::left || *capture.edge == BoardSide::top;
      const double edge = 0.5 * (sideways ? scene.board().width : scene.board().height);
      EXPECT_NEAR((sideways ? p_board.x() : p_board.y()) * (first ? -1.0 : 1.0), edge, 0.04);
    }
    EXPECT_GT(on_board, 5);
    EXPECT_LT(on_board, 95);
  }
}

TEST(SimulateCaptures, TheBoardsOfPlainCapturesDoNotDependOnHowManyThereAre) {
  const CaptureScene few(captureOptions(LaserKind::scan, 2));
  const CaptureScene more(captureOptions(LaserKind::scan, 6));
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(few.captures()[i].T_body_board, more.captures()[i].T_body_board);
}

TEST(SimulateCaptures, FilesHoldWhatTheLaserMeasured) {
  const test::TestFolder folder;
  simulateCaptures(captureOptions(LaserKind::cloud, 1), folder / "board");
  const CaptureScene scene(captureOptions(LaserKind::cloud, 1));
  const std::vector<CloudPoint> expected = measureCloud(scene, 0);
  const std::vector<CloudPoint> read = readCloudPoints(folder / "board" / "000_cloud.pcd");
  ASSERT_EQ(read.size(), expected.size());
  EXPECT_EQ(read[7000].p_laser, expected[7000].p_laser);
  EXPECT_EQ(test::bytesOf(folder / "board" / "captures.yaml"),
            "name: \"board\"\ncaptures: captures.csv\nrig: rig.yaml\nboard:\n  pattern: chessboard\n"
            "  inner_corners: [9, 6]\n  square: 0.0400\n  margin: 0.0200\n");
  EXPECT_EQ(test::bytesOf(folder / "board" / "captures.csv"),
            "thermal,visible,laser\n000_thermal.tiff,000_visible.jpg,000_cloud.pcd\n");
}

TEST(SimulateCaptures, TheGuessedRigIsOffAndTheTrueOneTold) {
  const CaptureScene scene(captureOptions(LaserKind::scan));
  const Laser& is = scene.trueRig().lasers.front();
  const Laser& guessed = scene.guessedRig().lasers.front();
  const double turned = is.T_body_laser.rotation.angularDistance(guessed.T_body_laser.rotation);
  EXPECT_GT(turned, 0.2 * M_PI / 180.0);
  EXPECT_LT(turned, 8.0 * M_PI / 180.0);
  EXPECT_LT((is.T_body_laser.translation - guessed.T_body_laser.translation).norm(), 0.1);
  EXPECT_EQ(scene.trueRig().thermal_camera->T_body_camera, scene.guessedRig().thermal_camera->T_body_camera);
  EXPECT_NE(scene.trueRig().thermal_camera->camera.fx(), scene.guessedRig().thermal_camera->camera.fx());
}

TEST(SimulateCaptures, SameSeedGivesSameBytesWithAnyNumberOfThreads) {
  for (const LaserKind kind : kKinds) {
    const test::TestFolder folder;
    CaptureOptions options = captureOptions(kind, 2);
    options.spoiled = 1;
    options.threads = 1;
    simulateCaptures(options, folder / "one" / "board");
    options.threads = 2;
    simulateCaptures(options, folder / "two" / "board");
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "one")) {
      if (!entry.is_regular_file()) continue;
      const fs::path other = folder / "two" / fs::relative(entry.path(), folder / "one").string();
      EXPECT_EQ(test::bytesOf(entry.path()), test::bytesOf(other)) << other;
      ++files;
    }
    EXPECT_EQ(files, 2U * 3U + 3U + 2U);
    options.seed = 6;
    EXPECT_NE(CaptureScene(options).captures()[0].T_body_board.translation,
              CaptureScene(captureOptions(kind)).captures()[0].T_body_board.translation);
  }
}

TEST(SimulateCaptures, RefusesOptionsThatCannotBe) {
  const auto refused = [](const auto& change, const char* word) {
    CaptureOptions options = captureOptions(LaserKind::cloud);
    change(options);
    EXPECT_THAT(test::messageOf<ConfigError>([&] { options.validate(); }), testing::HasSubstr(word));
  };
  refused([](CaptureOptions& o) { o.captures = 0; }, "captures is 0");
  refused([](CaptureOptions& o) { o.spoiled = 4; }, "spoiled");
  refused([](CaptureOptions& o) { o.edge_captures = 1; }, "edge_captures is 1");
  refused([](CaptureOptions& o) { o.range_sigma = -0.1; }, "range_sigma");
  refused([](CaptureOptions& o) { o.netd = std::nan(""); }, "netd");
  refused([](CaptureOptions& o) { o.contrast = 30.0; }, "contrast");
  refused([](CaptureOptions& o) { o.guess.rotation_sigma = 2.0; }, "rotation_sigma");
  refused([](CaptureOptions& o) { o.threads = 0; }, "threads");
}

}  // namespace
}  // namespace thermovox::simulate
