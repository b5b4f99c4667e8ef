// Under what conditions the missions were flown, and what the numbers are counted from.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/report_html.hpp"
#include "io/report_sections.hpp"
#include "io/rig_file.hpp"

namespace thermovox {
namespace {

std::string cameraText(const ThermalCamera& camera) {
  const Camera& lens = camera.camera;
  return fmt::format(
      "{} &times; {} px, focal length {:.0f} px; noise {:.3g} &deg;C, bias &pm; {:.3g} &deg;C, blur {}",
      lens.width(), lens.height(), std::sqrt(lens.fx() * lens.fy()), camera.netd, camera.bias_sigma,
      camera.knows_blur ? fmt::format("{:.2g} px", camera.blur_px) : "not known");
}

std::string laserText(const Laser& laser) {
  constexpr const char* kKinds[] = {"single beam", "scanner", "3D laser"};
  std::string text = fmt::format("{}, {:.3g} to {:.3g} m; one range &pm; {:.3g} mm",
                                 kKinds[static_cast<std::size_t>(laser.kind)], laser.range_min,
                                 laser.range_max, 1e3 * laser.range_sigma);
  if (laser.range_bias_sigma > 0.0) {
    text += fmt::format(", common &pm; {:.3g} mm", 1e3 * laser.range_bias_sigma);
  }
  return text + (laser.covariance_body_laser.isZero() ? "; mounting taken as exact"
                                                      : "; mounting with its covariance");
}

/// Missions of the same rig: the first of them, and the numbers of all.
struct RigUse {
  const MissionRecord* mission;
  std::string numbers;
};

std::vector<RigUse> rigsOf(const ReportContents& contents) {
  std::vector<RigUse> uses;
  for (std::size_t i = 0; i < contents.missions().size(); ++i) {
    const MissionRecord& mission = contents.missions()[i];
    const auto known = std::find_if(uses.begin(), uses.end(),
                                    [&](const RigUse& use) { return use.mission->rig == mission.rig; });
    if (known == uses.end()) {
      uses.push_back({&mission, missionNumber(i)});
    } else {
      known->numbers += ", " + missionNumber(i);
    }
  }
  return uses;
}

std::string rigTable(const ReportContents& contents) {
  HtmlTable table({"missions", "thermal camera", "laser"}, "lll");
  for (const RigUse& use : rigsOf(contents)) {
    if (use.mission->rig.empty()) {
      table.row({use.numbers, "not kept", "not kept"});
      continue;
    }
    const Rig rig = parseRig(use.mission->rig,
                             contents.report.station + ": the rig of mission '" + use.mission->name + "'");
    std::string lasers;
    for (const Laser& laser : rig.lasers) lasers += (lasers.empty() ? "" : "<br>") + laserText(laser);
    table.row({use.numbers, rig.thermal_camera ? cameraText(*rig.thermal_camera) : "none", lasers});
  }
  return table.html();
}

std::string ambientTable(const ReportContents& contents) {
  HtmlTable table({"#", "mission", "air", "whence", "poses", "mapped with"}, "rlrlll");
  for (std::size_t i = 0; i < contents.missions().size(); ++i) {
    const MissionRecord& mission = contents.missions()[i];
    const char* whence = contents.report.judgement.ambient ? "given for this report"
                         : mission.ambient                 ? "as the mission says"
                                                           : "median of the mission's own map";
    const PoseSigmas& sigmas = mission.pose_sigmas;
    const std::string poses =
        sigmas.rotation > 0.0 || sigmas.translation > 0.0
            ? fmt::format("&pm; {:.3g} mm, &pm; {:.2g} mrad", 1e3 * sigmas.translation, 1e3 * sigmas.rotation)
            : "taken as exact";
    table.row({missionNumber(i), named(mission.name), fmt::format("{:.1f} &deg;C", contents.ambients[i]),
               whence, poses, "thermovox " + escaped(mission.version)});
  }
  return table.html();
}

std::string severityTable(const SeverityTable& table) {
  HtmlTable html({"class", "rise over the air", "what to do"}, "lrl");
  double from = 0.0;
  for (const SeverityClass& entry : table.over_ambient) {
    html.row({escaped(entry.name),
              std::isfinite(entry.up_to) ? fmt::format("above {:g} up to {:g} &deg;C", from, entry.up_to)
                                         : fmt::format("above {:g} &deg;C", from),
              escaped(entry.action)});
    from = entry.up_to;
  }
  const std::string name =
      escaped(table.name) + (table.edition.empty() ? "" : ", edition " + escaped(table.edition));
  if (table.over_ambient.empty()) return "<p>" + name + ": has no classes for rises over the air.</p>\n";
  return "<p>" + name + ".</p>\n" + html.html();
}

}  // namespace

std::string criteriaText(const HotspotCriteria& criteria) {
  std::string text;
  if (criteria.above) text = fmt::format("{:g} &deg;C or more", *criteria.above);
  if (criteria.delta) {
    if (!text.empty()) text += ", or ";
    text += fmt::format("{:g} &deg;C or more over the surroundings on the same surface", *criteria.delta);
  }
  return text;
}

std::string conditionSection(const ReportContents& contents) {
  return "<h2 id=\"conditions\">Conditions and criteria</h2>\n<p><b>A hot spot is</b> what has " +
         criteriaText(contents.report.criteria) + ".</p>\n<h3>Air and poses</h3>\n" + ambientTable(contents) +
         "<h3>Rig</h3>\n" + rigTable(contents) + "<div class=\"block\"><h3>Severity</h3>\n" +
         severityTable(contents.report.judgement.table) + "</div>\n";
}

}  // namespace thermovox
