// Ten missions through one hall while it gets 15 C warmer: which joints warm, cool, are repaired or cannot be
// seen is planned, and what the station tells of them is to be just that.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "apps/simulate/hall_layout.hpp"
#include "apps/simulate/parallel.hpp"
#include "apps/simulate/simulated_sources.hpp"
#include "io/rig_file.hpp"
#include "io/station_hotspots.hpp"
#include "mapping/mission_mapper.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::test {
namespace {

using namespace simulate;

constexpr std::size_t kMissions = 10;
constexpr double kSameJoint = 0.2;  // metres

/// What is planned for one joint in one mission.
struct Plan {
  double rise = 0.0;    ///< C; 0: not hot
  bool hidden = false;  ///< by a box
  std::optional<HotspotState> state;
  bool alarm = false;
};

/// What happens to the joints, from the coolest on; nothing happens to the rest.
enum class Fate { warms, has_less_to_carry, is_repaired, is_hidden, comes_loose, stays };

/// By mission.
std::vector<Plan> planOf(Fate fate, double built) {
  std::vector<Plan> plan(kMissions, Plan{.rise = built, .state = HotspotState::steady});
  const auto from = [&plan](std::size_t mission, auto change) {
    for (std::size_t m = mission; m < kMissions; ++m) change(plan[m]);
  };
  plan[0].state = HotspotState::fresh;
  switch (fate) {
    case Fate::warms:
      from(5, [built](Plan& p) { p.rise = built + 3.0; });
      plan[5].state = HotspotState::growing;
      plan[5].alarm = true;
      break;
    case Fate::has_less_to_carry:
      from(4, [built](Plan& p) { p.rise = built - 8.0; });
      plan[4].state = HotspotState::cooling;
      break;
    case Fate::is_repaired:
      from(6, [](Plan& p) { p = {.rise = 0.0, .state = HotspotState::gone}; });
      break;
    case Fate::is_hidden:  // something stands before it, twice
      for (const std::size_t mission : {2, 7}) {
        plan[mission].hidden = true;
        plan[mission].state = HotspotState::not_observed;
      }
      break;
    case Fate::comes_loose:
      for (std::size_t m = 0; m < 8; ++m) plan[m] = {};
      plan[8].state = HotspotState::fresh;
      plan[8].alarm = true;
      break;
    case Fate::stays:
      break;
  }
  return plan;
}

/// Of all joints of a hall, each with a fate.
std::vector<std::vector<Plan>> plansOf(const Hall& hall) {
  const std::vector<HotSpot>& joints = hall.hotSpots();
  std::vector<std::size_t> coolest_first(joints.size());
  std::iota(coolest_first.begin(), coolest_first.end(), std::size_t{0});
  std::sort(coolest_first.begin(), coolest_first.end(),
            [&](std::size_t a, std::size_t b) { return joints[a].delta < joints[b].delta; });
  std::vector<std::vector<Plan>> plans(joints.size());
  for (std::size_t rank = 0; rank < joints.size(); ++rank) {
    const Fate fate = static_cast<Fate>(std::min(rank, static_cast<std::size_t>(Fate::stays)));
    plans[coolest_first[rank]] = planOf(fate, joints[coolest_first[rank]].delta);
  }
  return plans;
}

/// A third of a metre before a joint, towards the aisle; as warm as the season.
Box screenBefore(const HotSpot& joint, double warmer) {
  const double side = joint.position.y() > 0.0 ? 1.0 : -1.0;
  const double near = joint.position.y() - side * 0.36, far = joint.position.y() - side * 0.30;
  return {{joint.position.x() - 1.1, std::min(near, far), 0.0},
          {joint.position.x() + 1.1, std::max(near, far), joint.position.z() + 1.1},
          26.0 + warmer};
}

SimulationOptions flightOf(std::uint64_t hall_seed, std::size_t mission, const Hall& hall,
                           const std::vector<std::vector<Plan>>& plans) {
  SimulationOptions options;
  options.hall_seed = hall_seed;
  options.seed = 100 + mission;
  options.errors.pose_rotation_sigma = 0.002;
  options.errors.pose_translation_sigma = 0.01;
  options.errors.camera_bias_sigma = 1.0;
  options.flight = FlightStyle::facing_rows;
  options.duration = 16.0;
  options.changes.warmer = 15.0 * static_cast<double>(mission) / (kMissions - 1);
  for (std::size_t joint = 0; joint < plans.size(); ++joint) {
    options.changes.joint_rises[joint] = plans[joint][mission].rise;
    if (plans[joint][mission].hidden)
      options.changes.boxes.push_back(screenBefore(hall.hotSpots()[joint], options.changes.warmer));
  }
  return options;
}

struct Flown {
  MissionRecord record;
  ThermalMap map{ThermalMap::Options{}};
};

void fly(const SimulationOptions& options, const std::string& name, Flown& flown) {
  const Simulation simulation(options);
  const Mission mission = missionOf(simulation, name);
  SimulatedReadings readings(simulation);
  SimulatedFrames frames(simulation);
  const MissionReport report = mapMission({mission, readings, &frames}, flown.map, {});
  flown.record = {.name = name,
                  .rig = rigText(mission.rig),
                  .readings = static_cast<std::int64_t>(report.readings),
                  .points = static_cast<std::int64_t>(report.points),
                  .coloured = static_cast<std::int64_t>(report.coloured),
                  .first = report.first_stamp,
                  .last = report.last_stamp,
                  .version = "test",
                  .pose_sigmas = {mission.pose_rotation_sigma, mission.pose_translation_sigma},
                  .shared_motions = report.shared_motions,
                  .frame_poses = report.frame_poses};
}

/// All of them mapped into one station.
StationHotspots followed(std::uint64_t hall_seed, const Hall& hall,
                         const std::vector<std::vector<Plan>>& plans) {
  std::vector<Flown> flights(kMissions);
  forEachIndex(kMissions, 2, [&](std::size_t mission) {
    fly(flightOf(hall_seed, mission, hall, plans), "mission-" + std::to_string(mission), flights[mission]);
  });
  const TestFolder folder;
  Station station = Station::create(folder / "hall.tvx", flights.front().map.options());
  for (const Flown& flown : flights) station.addMission(flown.record, flown.map, KnownMission::refuse);
  return stationHotspots(station, {});
}

/// The joint that a spot is at; none: a false one.
std::optional<std::size_t> jointOf(const Hotspot& spot, const Hall& hall) {
  for (std::size_t joint = 0; joint < hall.hotSpots().size(); ++joint) {
    if ((spot.position.p_world - hall.hotSpots()[joint].position).norm() < kSameJoint) return joint;
  }
  return std::nullopt;
}

std::string wordOf(const std::optional<HotspotChange>& change) {
  if (!change) return "none";
  return nameOf(change->state) + std::string(change->alarm ? ", alarm" : "");
}

std::string wordOf(const Plan& plan) {
  if (!plan.state) return "none";
  return nameOf(*plan.state) + std::string(plan.alarm ? ", alarm" : "");
}

/// Tracks by the joint that they follow; every spot of a track is at its joint, and no joint has two.
std::map<std::size_t, const HotspotTrack*> tracksByJoint(const HotspotHistory& history, const Hall& hall) {
  std::map<std::size_t, const HotspotTrack*> tracks;
  for (const HotspotTrack& track : history.tracks()) {
    std::optional<std::size_t> joint;
    for (const std::optional<Hotspot>& spot : track.seen) {
      if (!spot) continue;
      const std::optional<std::size_t> at = jointOf(*spot, hall);
      EXPECT_TRUE(at) << "track " << track.id << " at " << spot->position.p_world.transpose();
      EXPECT_TRUE(!joint || joint == at) << "track " << track.id << " goes to another joint";
      joint = at;
    }
    if (joint) {
      EXPECT_TRUE(tracks.emplace(*joint, &track).second) << "joint " << *joint << " has two tracks";
    }
  }
  return tracks;
}

class TenMissions : public testing::TestWithParam<std::uint64_t> {};

TEST_P(TenMissions, EveryJointKeepsItsIdentityAndItsStatesAreThosePlanned) {
  const Hall hall = makeHall(GetParam());
  const std::vector<std::vector<Plan>> plans = plansOf(hall);
  ASSERT_GE(plans.size(), 5U);
  const StationHotspots found = followed(GetParam(), hall, plans);
  ASSERT_EQ(found.history.missions().size(), kMissions);
  const std::map<std::size_t, const HotspotTrack*> tracks = tracksByJoint(found.history, hall);
  EXPECT_EQ(found.history.tracks().size(), plans.size());
  for (std::size_t joint = 0; joint < plans.size(); ++joint) {
    ASSERT_TRUE(tracks.contains(joint)) << "joint " << joint;
    for (std::size_t mission = 0; mission < kMissions; ++mission) {
      const auto& change = tracks.at(joint)->changes[mission];
      EXPECT_EQ(wordOf(change), wordOf(plans[joint][mission]))
          << "joint " << joint << " in mission " << mission << ": change "
          << (change ? change->change.value : 0.0) << " +- " << (change ? change->change.sigma : 0.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Halls, TenMissions, testing::Values(5, 31));

}  // namespace
}  // namespace thermovox::test
