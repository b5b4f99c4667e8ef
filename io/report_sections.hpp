#pragma once

#include <string>
#include <vector>

#include "io/hotspot_report.hpp"
#include "mapping/surface_cloud.hpp"

namespace thermovox {

/// What the sections of a hot-spot report share.
struct ReportContents {
  const HotspotReport& report;
  std::vector<HotspotRow> rows;      ///< the hottest first
  std::vector<double> ambients;      ///< C, by mission
  std::vector<SurfacePoint> points;  ///< of the map

  [[nodiscard]] const std::vector<MissionRecord>& missions() const { return report.found.missions; }
  /// Of a row's spot over the missions.
  [[nodiscard]] const HotspotTrack& trackOf(const HotspotRow& row) const;
};

/// What holds a hot spot's position with 95 % (7.815, chi squared with three degrees of freedom).
struct Ellipsoid {
  Eigen::Vector3d half_axes;   ///< metres, the longest first
  Eigen::Matrix3d directions;  ///< of these, in the columns; the largest component is positive
};
[[nodiscard]] Ellipsoid ellipsoidOf(const HotspotPosition& position);

// Each gives HTML.
[[nodiscard]] std::string coverSection(const ReportContents& contents);
[[nodiscard]] std::string conditionSection(const ReportContents& contents);
[[nodiscard]] std::string mapSection(const ReportContents& contents);
[[nodiscard]] std::string summarySection(const ReportContents& contents);
[[nodiscard]] std::string spotSection(const ReportContents& contents, const HotspotRow& row);
/// Empty without assets.
[[nodiscard]] std::string assetSection(const ReportContents& contents);
[[nodiscard]] std::string countSection(const ReportContents& contents);
[[nodiscard]] std::string methodSection();

/// A class of the table of severities, in its colour; "none" where the rise has none.
[[nodiscard]] std::string severityChip(const HotspotRow& row, const SeverityTable& table);
/// "not observed" for not_observed.
[[nodiscard]] std::string stateText(const HotspotChange& change);
/// "at or above 60.0 &deg;C, or 10.0 &deg;C over the surroundings on the same surface"
[[nodiscard]] std::string criteriaText(const HotspotCriteria& criteria);
/// Those that the last mission did not find gone, nor failed to look at.
[[nodiscard]] std::vector<HotspotRow> standing(const std::vector<HotspotRow>& rows);
/// Missions count from 1 in a report.
[[nodiscard]] std::string missionNumber(std::size_t mission);

}  // namespace thermovox
