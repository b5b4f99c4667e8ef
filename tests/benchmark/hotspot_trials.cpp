#include "tests/benchmark/hotspot_trials.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "apps/simulate/parallel.hpp"
#include "apps/simulate/random.hpp"
#include "apps/simulate/simulated_sources.hpp"
#include "mapping/hotspot_detection.hpp"
#include "mapping/mission_mapper.hpp"
#include "mapping/shared_errors.hpp"
#include "mapping/surface_layer.hpp"

namespace thermovox::bench {
namespace {

using namespace simulate;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSameJoint = 0.3;      // metres
constexpr double kChi2Of3At95 = 7.815;  // 95 % of chi squared with three degrees of freedom

/// As in a hall a joint may lie near an edge of what it is on, with colder things in the same pixels.
Hall cabinetHall(std::uint64_t seed) {
  Random random(seed, RandomStream::hall);
  const double front = random.uniform(3.0, 5.5);
  const double celsius = random.uniform(22.0, 31.0);
  std::vector<HotSpot> joints;
  const double left = random.uniform(-1.6, -0.9);
  for (const double x : {left, left + random.uniform(1.0, 1.3)}) {
    const double rise = random.uniform(22.0, 62.0);
    joints.push_back(
        {{x, front, random.uniform(1.2, 2.3)}, rise, random.uniform(0.065, 0.125), celsius + rise});
  }
  const double top = std::max(joints[0].position.z(), joints[1].position.z());
  const Box cabinet{
      {left - random.uniform(0.1, 0.7), front, 0.0},
      {joints[1].position.x() + random.uniform(0.1, 0.7), front + 1.0, top + random.uniform(0.1, 0.7)},
      celsius};
  return {{8.0, 16.0, 5.0}, {cabinet}, {}, std::move(joints)};
}

Hall pipeHall(std::uint64_t seed) {
  Random random(seed, RandomStream::hall);
  const double front = random.uniform(3.0, 5.5);
  std::vector<Cylinder> pipes;
  std::vector<HotSpot> joints;
  double x = random.uniform(-1.6, -0.9);
  for (int i = 0; i < 2; ++i) {
    const double radius = random.uniform(0.09, 0.17), celsius = random.uniform(22.0, 31.0);
    const double turn = random.uniform(-35.0, 35.0) * kDegree;  // of the joint from the front
    const double rise = random.uniform(22.0, 62.0), z = random.uniform(1.2, 2.3);
    pipes.push_back({x, front + radius, radius, 3.5, celsius});
    joints.push_back({{x + radius * std::sin(turn), front + radius - radius * std::cos(turn), z},
                      rise,
                      random.uniform(0.065, 0.125),
                      celsius + rise});
    x += random.uniform(1.0, 1.3);
  }
  return {{8.0, 16.0, 5.0}, {}, std::move(pipes), std::move(joints)};
}

SimulationOptions optionsOf(const DeclaredErrors& errors, std::uint64_t seed) {
  SimulationOptions options;
  options.laser = LaserKind::cloud;
  options.flight = FlightStyle::facing_rows;
  options.seed = seed;
  options.duration = 1.0;
  options.errors = errors;
  return options;
}

JointTrial against(const HotSpot& joint, const std::vector<Hotspot>& spots) {
  JointTrial trial;
  const auto distanceOf = [&](const Hotspot& spot) {
    return (spot.position.p_world - joint.position).norm();
  };
  const auto nearest = std::min_element(spots.begin(), spots.end(), [&](const Hotspot& a, const Hotspot& b) {
    return distanceOf(a) < distanceOf(b);
  });
  if (nearest == spots.end() || distanceOf(*nearest) > kSameJoint) return trial;
  trial.found = true;
  trial.error = nearest->position.p_world - joint.position;
  trial.distance = trial.error.norm();
  trial.mahalanobis2 = trial.error.dot(nearest->position.covariance().ldlt().solve(trial.error));
  trial.random2 = nearest->position.random.trace();
  trial.common2 = nearest->position.common.trace();
  trial.peak_error = nearest->peak.value - joint.peak;
  trial.peak_z = trial.peak_error / nearest->peakSigma();
  return trial;
}

}  // namespace

std::vector<JointTrial> hotspotTrial(const ErrorSet& set, std::uint64_t seed) {
  const Simulation simulation(optionsOf(set.errors, seed),
                              set.scene == TrialScene::pipes ? pipeHall(seed) : cabinetHall(seed));
  const Mission mission = missionOf(simulation, "trial");
  SimulatedReadings readings(simulation);
  SimulatedFrames frames(simulation);
  ThermalMap map(ThermalMap::Options{});
  const MissionReport report = mapMission({mission, readings, &frames}, map, {});
  const SurfaceLayer layer(map);
  std::vector<Hotspot> spots =
      findHotspots(layer, {}, sightOf(*mission.rig.thermal_camera, report.frame_poses));
  for (Hotspot& spot : spots) {
    spot.position.common =
        sharedCovariance(spot.position.p_world, spot.normal, report.shared_motions, mission.rig,
                         {mission.pose_rotation_sigma, mission.pose_translation_sigma});
  }
  std::vector<JointTrial> trials;
  for (const HotSpot& joint : simulation.hall().hotSpots()) trials.push_back(against(joint, spots));
  return trials;
}

std::vector<JointTrial> hotspotTrials(const ErrorSet& set, std::uint64_t first, std::size_t count) {
  std::vector<std::vector<JointTrial>> by_run(count);
  forEachIndex(count, std::max(1U, std::thread::hardware_concurrency()),
               [&](std::size_t i) { by_run[i] = hotspotTrial(set, first + i); });
  std::vector<JointTrial> trials;
  for (const std::vector<JointTrial>& run : by_run) trials.insert(trials.end(), run.begin(), run.end());
  return trials;
}

TrialSummary summaryOf(const std::vector<JointTrial>& trials) {
  TrialSummary sums{.joints = trials.size()};
  for (const JointTrial& trial : trials) {
    if (!trial.found) continue;
    ++sums.found;
    sums.position_coverage += trial.mahalanobis2 < kChi2Of3At95 ? 1.0 : 0.0;
    sums.position_nees += trial.mahalanobis2 / 3.0;
    sums.peak_coverage += std::abs(trial.peak_z) < 1.96 ? 1.0 : 0.0;
    sums.peak_nees += trial.peak_z * trial.peak_z;
    sums.mean_distance += trial.distance;
    sums.mean_peak_error += std::abs(trial.peak_error);
  }
  const double found = std::max<double>(static_cast<double>(sums.found), 1.0);
  for (double* mean : {&sums.position_coverage, &sums.position_nees, &sums.peak_coverage, &sums.peak_nees,
                       &sums.mean_distance, &sums.mean_peak_error}) {
    *mean /= found;
  }
  return sums;
}

std::vector<ErrorSet> errorSets() {
  const double rotation = 0.3 * kDegree, translation = 0.008;
  Vector6d variances;
  variances.head<3>().setConstant(rotation * rotation);
  variances.tail<3>().setConstant(translation * translation);
  std::vector<ErrorSet> sets(6);
  sets[0].name = "noise alone";
  sets[1].name = "pose: 0.2 degrees, 1 cm";
  sets[1].errors.pose_rotation_sigma = 0.2 * kDegree;
  sets[1].errors.pose_translation_sigma = 0.01;
  sets[2].name = "extrinsics: 0.3 degrees, 8 mm; range bias 1 cm";
  sets[2].errors.covariance_body_laser = variances.asDiagonal();
  sets[2].errors.range_bias_sigma = 0.01;
  sets[3].name = "camera bias: 2 C";
  sets[3].errors.camera_bias_sigma = 2.0;
  sets[4].name = "noise alone, joints on pipes";
  sets[4].scene = TrialScene::pipes;
  sets[5].name = "all";
  sets[5].errors = sets[2].errors;
  sets[5].errors.pose_rotation_sigma = sets[1].errors.pose_rotation_sigma;
  sets[5].errors.pose_translation_sigma = sets[1].errors.pose_translation_sigma;
  sets[5].errors.camera_bias_sigma = sets[3].errors.camera_bias_sigma;
  return sets;
}

}  // namespace thermovox::bench
