#include "apps/simulate/capture_writer.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "apps/simulate/capture_laser.hpp"
#include "apps/simulate/capture_render.hpp"
#include "apps/simulate/instrument_files.hpp"
#include "apps/simulate/output_folder.hpp"
#include "apps/simulate/parallel.hpp"
#include "io/picture_canvas.hpp"
#include "io/rig_file.hpp"
#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTruth = ".truth.json";
constexpr const char* kTruthRig = ".truth_rig.yaml";

std::string numbered(std::size_t capture, const char* ending) {
  return fmt::format("{:03}_{}", capture, ending);
}

const char* laserEnding(LaserKind kind) {
  switch (kind) {
    case LaserKind::beam:
      return "beam.csv";
    case LaserKind::scan:
      return "scans.csv";
    case LaserKind::cloud:
      break;
  }
  return "cloud.pcd";
}

void writeDescription(const CaptureScene& scene, const std::string& name, const fs::path& folder) {
  const CalibrationBoard& board = scene.board();
  writeText(folder / "captures.yaml",
            fmt::format("name: \"{}\"\ncaptures: captures.csv\nrig: rig.yaml\nboard:\n  pattern: chessboard\n"
                        "  inner_corners: [{}, {}]\n  square: {:.4f}\n  margin: {:.4f}\n",
                        name, board.columns, board.rows, board.square, scene.margin()));
  std::string table = "thermal,visible,laser\n";
  for (std::size_t i = 0; i < scene.captures().size(); ++i) {
    table += numbered(i, "thermal.tiff") + "," + numbered(i, "visible.jpg") + "," +
             numbered(i, laserEnding(scene.options().laser)) + "\n";
  }
  writeText(folder / "captures.csv", table);
  writeRig(folder / "rig.yaml", scene.guessedRig());
}

std::string beamText(const CaptureScene& scene, std::size_t capture) {
  std::string text = "timestamp,range\n";
  for (const BeamReading& beam : measureBeam(scene, capture))
    text += formatTime(beam.stamp) + fmt::format(",{:.4f}\n", beam.range);
  return text;
}

std::string scansText(const CaptureScene& scene, std::size_t capture) {
  std::string text = "timestamp,ranges...\n";
  for (const CaptureSweep& sweep : measureScans(scene, capture)) {
    text += formatTime(sweep.stamp);
    for (const float range : sweep.ranges) text += fmt::format(",{:.4f}", range);
    text += '\n';
  }
  return text;
}

void writeLaser(const CaptureScene& scene, std::size_t capture, const fs::path& folder) {
  const LaserKind kind = scene.options().laser;
  const fs::path file = folder / numbered(capture, laserEnding(kind));
  switch (kind) {
    case LaserKind::beam:
      writeText(file, beamText(scene, capture));
      break;
    case LaserKind::scan:
      writeText(file, scansText(scene, capture));
      break;
    case LaserKind::cloud:
      writeCloudPcd(file, measureCloud(scene, capture), PointTimes::left_out);
      break;
  }
}

void writeCapture(const CaptureRenderer& renderer, const CaptureScene& scene, std::size_t capture,
                  const fs::path& folder) {
  const Camera& thermal = scene.trueRig().thermal_camera->camera;
  const Camera& visible = scene.trueRig().visible_camera->camera;
  writeThermalTiff(folder / numbered(capture, "thermal.tiff"), thermal.width(),
                   renderer.thermalCounts(capture));
  std::vector<std::uint8_t> luminance = renderer.luminance(capture);
  writePicture(folder / numbered(capture, "visible.jpg"),
               cv::Mat(visible.height(), visible.width(), CV_8U, luminance.data()), Existing::refuse);
  writeLaser(scene, capture, folder);
}

/// Board poses as the truth of the given captures has them: origin at the first inner corner.
std::string truthText(const CaptureScene& scene) {
  nlohmann::ordered_json truth = nlohmann::ordered_json::array();
  for (const BoardCapture& capture : scene.captures()) {
    const Eigen::Matrix3d R = capture.T_body_board.matrix();
    const Eigen::Vector3d t = capture.T_body_board * scene.firstCorner();
    auto rows = nlohmann::ordered_json::array();
    for (int i = 0; i < 3; ++i) rows.push_back({R(i, 0), R(i, 1), R(i, 2)});
    truth.push_back({{"R", rows}, {"t", {t.x(), t.y(), t.z()}}, {"bad", capture.spoiled}});
  }
  return truth.dump() + "\n";
}

}  // namespace

fs::path truthRigPath(const fs::path& out) {
  return beside(out, kTruthRig);
}

void simulateCaptures(const CaptureOptions& options, const fs::path& out) {
  const CaptureScene scene(options);
  const OutputFolder output(out, {kTruth, kTruthRig});
  const fs::path folder = output.folder();
  try {
    fs::create_directories(folder);
    writeDescription(scene, output.name(), folder);
    const CaptureRenderer renderer(scene);
    forEachIndex(scene.captures().size(), options.threads,
                 [&](std::size_t capture) { writeCapture(renderer, scene, capture, folder); });
    writeText(output.file(kTruth), truthText(scene));
    writeRig(output.file(kTruthRig), scene.trueRig());
    output.commit();
  } catch (const fs::filesystem_error& error) {
    throw DataError(error.path1().string() + ": could not be written (" + error.code().message() +
                    "), expected a folder with room for it");
  }
}

}  // namespace thermovox::simulate
