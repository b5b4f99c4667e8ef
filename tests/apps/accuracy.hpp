#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "apps/simulate/mission_writer.hpp"
#include "apps/simulate/truth.hpp"
#include "io/mission_folder.hpp"
#include "mapping/mission_mapper.hpp"
#include "tests/support/recordings.hpp"

// What the points of a mission are worth, measured against the truth of its simulation.
namespace thermovox::test {

using simulate::Hall;

/// Temperature errors of a set of points, C.
class Errors {
 public:
  void add(double error) {
    ++count_;
    sum_ += std::abs(error);
    squares_ += error * error;
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double mae() const { return sum_ / static_cast<double>(count_); }
  [[nodiscard]] double rms() const { return std::sqrt(squares_ / static_cast<double>(count_)); }

 private:
  std::size_t count_ = 0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

/// What a mission's points are worth.
struct Accuracy {
  std::size_t points = 0;
  Errors coloured;
  Errors perfect;           ///< of the points that are visible in truth, by the true visibility
  Errors sure;              ///< of the coloured that report a sigma under 0.3 C
  double kept = 0.0;        ///< share of the perfectly visible points that got a temperature
  double within_2 = 0.0;    ///< share of the errors within two of the reported sigmas
  double median_z = 0.0;    ///< of |error| / sigma
  double position_rms = 0;  ///< of the points to the surface, metres
  [[nodiscard]] double sureShare() const {
    return static_cast<double>(sure.count()) / static_cast<double>(coloured.count());
  }
};

/// The frames of a mission with what a perfect colouring asks of them.
class PerfectColouring {
 public:
  PerfectColouring(const std::filesystem::path& mission, const Hall& hall)
      : hall_(hall), opened_(openMission(mission)) {
    while (const auto frame = opened_.frames->next()) {
      const auto T_world_body = opened_.mission.trajectory.at(frame->stamp);
      if (!std::holds_alternative<Pose>(T_world_body)) continue;
      const Pose T_world_camera = std::get<Pose>(T_world_body) * camera().T_body_camera;
      frames_.push_back({*frame, T_world_camera, T_world_camera.inverse()});
    }
    limit_ = opened_.frames->period() / 2 + std::chrono::milliseconds(50);
  }

  /// What the frame nearest in time shows of the point, if the point is visible in truth.
  [[nodiscard]] std::optional<double> celsiusOf(const PlacedReturn& point) const {
    const auto distance = [&](const Frame& f) {
      const Duration d = f.frame.stamp - point.stamp;
      return d < Duration::zero() ? -d : d;
    };
    const auto nearest =
        std::min_element(frames_.begin(), frames_.end(),
                         [&](const Frame& a, const Frame& b) { return distance(a) < distance(b); });
    if (nearest == frames_.end() || distance(*nearest) > limit_) return std::nullopt;
    const auto pixel = camera().camera.project(nearest->T_camera_world * point.p_world);
    if (!pixel || hall_.occluded(nearest->T_world_camera.translation, point.p_world)) return std::nullopt;
    const auto sample = sampleTemperature(*nearest->frame.image, *pixel, camera().netd);
    return sample ? std::optional<double>(sample->celsius) : std::nullopt;
  }

  /// Whether any frame sees the point in truth, from at most `range` metres.
  [[nodiscard]] bool isSeen(const Eigen::Vector3d& p_world, double range) const {
    return std::any_of(frames_.begin(), frames_.end(), [&](const Frame& f) {
      return camera().camera.project(f.T_camera_world * p_world) &&
             (p_world - f.T_world_camera.translation).norm() <= range &&
             !hall_.occluded(f.T_world_camera.translation, p_world);
    });
  }
  [[nodiscard]] const ThermalCamera& camera() const { return *opened_.mission.rig.thermal_camera; }

 private:
  struct Frame {
    ThermalFrame frame;
    Pose T_world_camera;
    Pose T_camera_world;
  };

  const Hall& hall_;
  OpenedMission opened_;
  std::vector<Frame> frames_;
  Duration limit_{};
};

/// How a mission is mapped.
struct Look {
  MissionMapper::Pass pass = MissionMapper::Pass::only;
  const ThermalMap* known = nullptr;  ///< geometry besides the mission's own
};

struct Mapped {
  ThermalMap map{ThermalMap::Options{}};
  std::vector<ColouredReturn> points;
};

inline void mapGeometry(const std::filesystem::path& mission, ThermalMap& map) {
  OpenedMission opened = openMission(mission);
  (void)mapMission({opened.mission, *opened.readings, nullptr}, map, {});
}

inline Mapped mapped(const std::filesystem::path& mission, const Look& look) {
  Mapped result;
  MissionMapper::Options options{.pass = look.pass};
  std::optional<SceneSurfaces> scene;
  if (look.pass != MissionMapper::Pass::only) {
    mapGeometry(mission, result.map);
    std::vector<const ThermalMap*> maps{&result.map};
    if (look.known != nullptr) maps.push_back(look.known);
    options.scene = &scene.emplace(maps);
  }
  OpenedMission opened = openMission(mission);
  (void)mapMission({opened.mission, *opened.readings, opened.frames.get()}, result.map, options,
                   {.points = [&result](std::span<const ColouredReturn> reading) {
                     result.points.insert(result.points.end(), reading.begin(), reading.end());
                   }});
  return result;
}

inline Accuracy accuracyOf(const std::filesystem::path& mission, const Hall& hall, const Look& look = {}) {
  const PerfectColouring perfect(mission, hall);
  Accuracy result;
  std::size_t kept = 0;
  std::vector<double> z;
  double squares = 0.0;
  const std::vector<ColouredReturn> points = mapped(mission, look).points;
  for (const ColouredReturn& point : points) {
    const simulate::NearestSurface truth = hall.nearestSurface(point.placed.p_world);
    squares += truth.distance * truth.distance;
    if (const auto shown = perfect.celsiusOf(point.placed)) {
      result.perfect.add(*shown - truth.temperature);
      kept += point.colour.has_value();
    }
    if (!point.colour) continue;
    const double error = point.colour->celsius - truth.temperature;
    result.coloured.add(error);
    z.push_back(std::abs(error) / point.colour->sigma);
    if (point.colour->sigma < 0.3F) result.sure.add(error);
  }
  result.points = points.size();
  result.position_rms = std::sqrt(squares / static_cast<double>(points.size()));
  result.kept = static_cast<double>(kept) / static_cast<double>(result.perfect.count());
  const auto good = std::count_if(z.begin(), z.end(), [](double value) { return value <= 2.0; });
  result.within_2 = static_cast<double>(good) / static_cast<double>(z.size());
  std::nth_element(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(z.size() / 2), z.end());
  result.median_z = z[z.size() / 2];
  return result;
}

/// The figures in the test's log and in its XML.
inline void record(const std::string& mission, const Accuracy& a) {
  char text[400];
  std::snprintf(
      text, sizeof text,
      "%zu points, %zu coloured: MAE %.4f rms %.3f C | perfect visibility: %zu, MAE %.4f rms %.3f, "
      "kept %.2f %% | sigma < 0.3: %.1f %%, MAE %.4f rms %.3f | within 2 sigma %.2f %%, median |e|/sigma "
      "%.2f | position rms %.2f mm",
      a.points, a.coloured.count(), a.coloured.mae(), a.coloured.rms(), a.perfect.count(), a.perfect.mae(),
      a.perfect.rms(), 100 * a.kept, 100 * a.sureShare(), a.sure.mae(), a.sure.rms(), 100 * a.within_2,
      a.median_z, 1000 * a.position_rms);
  std::printf("%s: %s\n", mission.c_str(), text);
  testing::Test::RecordProperty(mission, text);
}

/// Declared sigmas of about the size of the errors: a bar too wide is as dishonest as one too narrow.
inline void expectHonestSigmas(const Accuracy& accuracy) {
  EXPECT_GE(accuracy.within_2, 0.93);
  EXPECT_GE(accuracy.median_z, 0.3);
  EXPECT_LE(accuracy.median_z, 0.9);
}

inline Accuracy recordedAccuracy(const std::string& name, const Look& look = {}) {
  const std::filesystem::path mission = *recordings() / "missions" / name;
  const Accuracy accuracy =
      accuracyOf(mission, simulate::readTrueHall(mission.string() + ".truth.json"), look);
  record(look.pass == MissionMapper::Pass::only ? name : name + " in two passes", accuracy);
  return accuracy;
}

inline Accuracy flownAccuracy(const std::string& name, LaserKind laser, std::uint64_t seed, LensModel lens,
                              const Look& look = {}) {
  const TestFolder folder;
  simulate::SimulationOptions options;
  options.laser = laser;
  options.seed = seed;
  options.lens = lens;
  simulate::simulateMission(options, folder / "hall");
  const Accuracy accuracy =
      accuracyOf(folder / "hall", simulate::readTrueHall(simulate::truthPath(folder / "hall")), look);
  record(name, accuracy);
  return accuracy;
}

}  // namespace thermovox::test
