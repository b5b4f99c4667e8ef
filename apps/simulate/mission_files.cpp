#include "apps/simulate/mission_files.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numeric>
#include <vector>

#include "apps/simulate/instrument_files.hpp"
#include "apps/simulate/laser_sampling.hpp"
#include "apps/simulate/parallel.hpp"
#include "apps/simulate/radiometric_jpeg.hpp"
#include "apps/simulate/simulated_rig.hpp"
#include "apps/simulate/thermal_render.hpp"
#include "apps/simulate/visible_render.hpp"
#include "io/picture_canvas.hpp"
#include "io/rig_file.hpp"

namespace thermovox::simulate {
namespace {

/// printf into a string of at most 200 characters.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...) {
  char text[200];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

/// "folder/000007.ending".
std::string numbered(const char* folder, std::size_t number, const char* ending) {
  return formatted("%s/%06zu.%s", folder, number, ending);
}

const char* laserFile(LaserKind kind) {
  switch (kind) {
    case LaserKind::beam:
      return "beam.csv";
    case LaserKind::scan:
      return "scans.csv";
    case LaserKind::cloud:
      break;
  }
  return "clouds.csv";
}

/// The list of the files of all frames.
std::string frameTable(const Simulation& simulation, const char* folder, const char* ending) {
  std::string table = "timestamp,file\n";
  for (std::size_t frame = 0; frame < simulation.frameCount(); ++frame)
    table += formatTime(simulation.frameStamp(frame)) + "," + numbered(folder, frame, ending) + "\n";
  return table;
}

/// One row of the laser's table, and how many echoes it stands for.
struct Row {
  std::string text;
  std::size_t echoes = 0;
};

Row beamRow(const Simulation& simulation, std::size_t sweep) {
  const BeamReading beam = sampleBeam(simulation, sweep);
  return {formatTime(beam.stamp) + formatted(",%.4f,%.0f\n", beam.range, beam.intensity),
          std::isfinite(beam.range) ? 1U : 0U};
}

Row scanRow(const Simulation& simulation, std::size_t sweep) {
  Row row{formatTime(simulation.sweepStamp(sweep)), 0};
  for (const float range : sampleScan(simulation, sweep)) {
    row.text += formatted(",%.4f", range);
    if (std::isfinite(range)) ++row.echoes;
  }
  row.text += '\n';
  return row;
}

Row cloudRow(const Simulation& simulation, const std::filesystem::path& folder, std::size_t sweep) {
  const std::string file = numbered("clouds", sweep, "pcd");
  const std::vector<CloudPoint> points = sampleCloud(simulation, sweep);
  writeCloudPcd(folder / file, points);
  return {formatTime(simulation.sweepStamp(sweep)) + "," + file + "\n", points.size()};
}

Row laserRow(const Simulation& simulation, const std::filesystem::path& folder, std::size_t sweep) {
  switch (simulation.options().laser) {
    case LaserKind::beam:
      return beamRow(simulation, sweep);
    case LaserKind::scan:
      return scanRow(simulation, sweep);
    case LaserKind::cloud:
      break;
  }
  return cloudRow(simulation, folder, sweep);
}

const char* laserHeader(LaserKind kind) {
  switch (kind) {
    case LaserKind::beam:
      return "timestamp,range,strength\n";
    case LaserKind::scan:
      return "timestamp,ranges\n";
    case LaserKind::cloud:
      break;
  }
  return "timestamp,file\n";
}

}  // namespace

void writeDescriptions(const Simulation& simulation, const std::string& name,
                       const std::filesystem::path& folder) {
  const DeclaredErrors& errors = simulation.options().errors;
  std::string text =
      "name: \"" + name + "\"\nrig: rig.yaml\ntrajectory: trajectory.tum\nthermal: thermal.csv\n";
  if (simulation.rig().visible_camera) text += "visible: visible.csv\n";
  text += std::string("laser: ") + laserFile(simulation.options().laser) + "\n";
  if (errors.pose_rotation_sigma > 0.0 || errors.pose_translation_sigma > 0.0) {
    text += formatted("pose_sigma: {rotation: %.9g, translation: %.9g}\n", errors.pose_rotation_sigma,
                      errors.pose_translation_sigma);
  }
  writeText(folder / "mission.yaml", text);
  writeRig(folder / "rig.yaml", simulation.rig());
}

void writeTrajectory(const Simulation& simulation, const std::filesystem::path& folder) {
  std::string text = "# timestamp tx ty tz qx qy qz qw (T_world_body)\n";
  for (const auto& [stamp, pose] : simulation.writtenPoses()) {
    const Eigen::Vector3d& t = pose.translation;
    const Eigen::Vector4d& q = pose.rotation.coeffs();
    text += formatTime(stamp) + formatted(" %.9f %.9f %.9f", t.x(), t.y(), t.z()) +
            formatted(" %.12f %.12f %.12f %.12f\n", q.x(), q.y(), q.z(), q.w());
  }
  writeText(folder / "trajectory.tum", text);
}

void writeThermalFrames(const Simulation& simulation, const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder / "thermal");
  const ThermalRenderer renderer(simulation);
  const bool radiometric = simulation.options().frames == FrameFormat::rjpeg;
  const char* const ending = radiometric ? "jpg" : "tiff";
  const int width = simulation.rig().thermal_camera->camera.width();
  forEachIndex(simulation.frameCount(), simulation.options().threads, [&](std::size_t frame) {
    const std::filesystem::path file = folder / numbered("thermal", frame, ending);
    const std::vector<std::uint16_t> counts = renderer.counts(frame);
    if (radiometric) {
      writeRadiometricJpeg(file, width, counts, makeRadiometry(simulation.options()));
    } else {
      writeThermalTiff(file, width, counts);
    }
  });
  writeText(folder / "thermal.csv", frameTable(simulation, "thermal", ending));
}

void writeVisiblePictures(const Simulation& simulation, const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder / "visible");
  const MountedCamera& visible = *simulation.rig().visible_camera;
  const Camera& camera = visible.camera;
  forEachIndex(simulation.frameCount(), simulation.options().threads, [&](std::size_t frame) {
    const Pose T_world_camera = simulation.truePose(simulation.frameStamp(frame)) * visible.T_body_camera;
    std::vector<std::uint8_t> luminance = renderVisible(simulation.hall(), camera, T_world_camera);
    const cv::Mat picture(camera.height(), camera.width(), CV_8U, luminance.data());
    writePicture(folder / numbered("visible", frame, "jpg"), picture, Existing::refuse);
  });
  writeText(folder / "visible.csv", frameTable(simulation, "visible", "jpg"));
}

std::size_t writeLaser(const Simulation& simulation, const std::filesystem::path& folder) {
  const LaserKind kind = simulation.options().laser;
  if (kind == LaserKind::cloud) std::filesystem::create_directory(folder / "clouds");
  std::vector<Row> rows(simulation.sweepCount());
  forEachIndex(rows.size(), simulation.options().threads,
               [&](std::size_t sweep) { rows[sweep] = laserRow(simulation, folder, sweep); });
  std::string table = laserHeader(kind);
  for (const Row& row : rows) table += row.text;
  writeText(folder / laserFile(kind), table);
  return std::accumulate(rows.begin(), rows.end(), std::size_t{0},
                         [](std::size_t sum, const Row& row) { return sum + row.echoes; });
}

}  // namespace thermovox::simulate
