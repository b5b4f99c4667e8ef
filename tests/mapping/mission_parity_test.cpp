// The oracle for occupancy on whole recordings: every reading of a mission through OctoMap and through the
// map.

#include <gtest/gtest.h>

#include "io/mission_folder.hpp"
#include "projection/placement.hpp"
#include "tests/support/octomap_oracle.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

/// The returns of a reading that the trajectory has a pose for.
std::vector<MappedReturn> placed(const Reading& reading, const Mission& mission) {
  std::vector<MappedReturn> returns;
  for (const LaserReturn& ret : reading.returns) {
    const auto place = thermovox::place(ret, mission.rig.lasers.at(reading.laser), mission);
    const auto* found = std::get_if<PlacedReturn>(&place);
    if (found) returns.push_back({found->p_world, found->origin_world, ret.stamp, std::nullopt});
  }
  return returns;
}

void expectParityOn(const std::string& name, double resolution) {
  const OpenedMission opened = openMission(*test::recordings() / "missions" / name);
  test::OctomapOracle oracle({.resolution = resolution});
  while (const std::optional<Reading> reading = opened.readings->next()) {
    const std::vector<MappedReturn> returns = placed(*reading, opened.mission);
    if (!returns.empty()) oracle.integrate(returns);
  }
  oracle.expectParity();
}

TEST(MissionParity, OnTheWholeOfARecorded2dMission) {
  THERMOVOX_NEEDS_RECORDINGS();
  expectParityOn("intel", 0.1);
}

TEST(MissionParity, OnTheWholeOfASimulatedFlight) {
  THERMOVOX_NEEDS_RECORDINGS();
  expectParityOn("hall-scan", 0.1);
}

}  // namespace
}  // namespace thermovox
