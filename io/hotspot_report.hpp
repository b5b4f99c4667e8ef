#pragma once

#include <string>

#include "io/hotspot_table.hpp"
#include "io/spot_images.hpp"
#include "mapping/thermal_map.hpp"

namespace thermovox {

/// What a report is about. All it refers to has to outlive the call.
struct HotspotReport {
  std::string title;
  std::string station;  ///< the file's name
  std::string version;  ///< of thermovox
  HotspotCriteria criteria;
  HotspotJudgement judgement;
  const StationHotspots& found;
  const ThermalMap& map;  ///< of all missions
  SpotImagesById images;  ///< may be empty: a station keeps no images
};

/// The inspection report as one HTML file that needs nothing beside it: cover, map with the hot spots marked,
/// list, a page for each spot, assets where the judgement has some, counts, how each number was made. The
/// same input gives the same bytes: no clock is read. Throws DataError when the map holds no surface or a
/// mission's rig cannot be read.
[[nodiscard]] std::string hotspotReportHtml(const HotspotReport& report);

}  // namespace thermovox
