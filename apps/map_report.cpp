#include "apps/map_report.hpp"

#include <spdlog/spdlog.h>

#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace thermovox {
namespace {

nlohmann::ordered_json missionJson(const MissionReport& report) {
  return {{"mission", report.mission},
          {"readings", report.readings},
          {"points", report.points},
          {"coloured", report.coloured},
          {"painted", report.painted},
          {"uncoloured", report.uncoloured},
          {"dropped", report.dropped},
          {"outside_calibration", report.outside_calibration},
          {"painted_outside_calibration", report.painted_outside_calibration}};
}

void printCounts(const char* title, const std::map<std::string, std::size_t>& counts) {
  if (counts.empty()) return;
  std::cout << "  " << title;
  const char* separator = " ";
  for (const auto& [reason, n] : counts) {
    std::cout << separator << reason << ' ' << n;
    separator = ", ";
  }
  std::cout << '\n';
}

}  // namespace

void warnOfCalibration(const MissionReport& report) {
  if (report.painted_outside_calibration > 0) {
    spdlog::warn(
        "mission {}: {} of the temperatures that its frames painted lie outside those that the camera is "
        "calibrated for; they are taken as they are",
        report.mission, report.painted_outside_calibration);
  }
  if (report.outside_calibration == 0) return;
  spdlog::warn(
      "mission {}: {} of its {} coloured points have temperatures outside those that the camera is "
      "calibrated "
      "for; they are taken as they are",
      report.mission, report.outside_calibration, report.coloured);
}

void printJson(const MapResult& result) {
  nlohmann::ordered_json json;
  json["missions"] = nlohmann::ordered_json::array();
  for (const MissionReport& report : result.missions) json["missions"].push_back(missionJson(report));
  if (result.missions.size() == 1) json.update(missionJson(result.missions.front()));
  json["voxels"] = result.voxels;
  json["spilled_tiles"] = result.spilled_tiles;
  json["seconds"] = result.seconds;
  json["points_per_second"] = result.pointsPerSecond();
  std::cout << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

void printText(const MapResult& result, const std::filesystem::path& station) {
  for (const MissionReport& report : result.missions) {
    std::cout << report.mission << ": " << report.readings << " readings, " << report.points << " points, "
              << report.coloured << " with a temperature\n";
    if (report.painted > 0) std::cout << "  painted: " << report.painted << " cells\n";
    printCounts("without:", report.uncoloured);
    printCounts("dropped:", report.dropped);
  }
  std::cout << station.string() << ": " << result.voxels << " cells hold a surface, mapped in "
            << result.seconds << " s\n";
  if (result.spilled_tiles > 0) {
    std::cout << "  tiles went to a file " << result.spilled_tiles
              << " times for want of memory: more --memory makes it faster\n";
  }
}

}  // namespace thermovox
