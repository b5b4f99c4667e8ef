#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapping/hotspot.hpp"
#include "mapping/surface_blur.hpp"
#include "mapping/surface_layer.hpp"

namespace thermovox {

/// What became of a hot spot.
enum class HotspotState { fresh, growing, steady, cooling, gone, not_observed };
/// The word of the reports: "new", "growing", "steady", "cooling", "gone", "not_observed".
[[nodiscard]] const char* nameOf(HotspotState state);

/// Between two missions; all on delta over the surroundings, so that a season does not count.
struct HotspotChange {
  std::optional<Estimate> from;  ///< delta before, C; none where nobody looked
  std::optional<Estimate> to;    ///< delta after, C; likewise
  Estimate change;               ///< C; zero where one of the two is not known
  HotspotState state = HotspotState::steady;
  bool alarm = false;  ///< a spot that is new, or has grown

  [[nodiscard]] double significance() const;  ///< |change| in its sigmas; 0 where it is not known
};

/// One mission, for the history.
struct MissionSight {
  std::string mission;
  const SurfaceLayer* layer = nullptr;  ///< its temperatures; must outlive the history
  std::vector<Hotspot> hotspots;        ///< as findHotspots gives them, with their shared errors
  CameraSight camera = {};              ///< what saw it
};

/// One hot spot over the missions.
struct HotspotTrack {
  int id = 0;                                ///< from 1 on, in the order of their first sights
  std::vector<std::optional<Hotspot>> seen;  ///< by mission
  /// By mission: against the mean of the missions that saw the spot since its last change, weighted by their
  /// sigmas; none before the first.
  std::vector<std::optional<HotspotChange>> changes;

  /// The last mission that saw it.
  [[nodiscard]] std::size_t lastSeen() const;
};

/// The hot spots of a station over its missions.
///
/// A spot of one mission is that of an earlier one where their places agree: the squared Mahalanobis distance
/// under both covariances and half the larger width, with a term for the ratio of the widths, is below 16.27
/// (99.9 % of chi squared with three degrees of freedom), and the sum over all pairs is the least. A change
/// counts from 2 C on, when it is three and a half sigmas, and not against a lower value that is a bound.
/// Where no spot was found a mission's own temperatures tell what became of it: at least half of its cells
/// have to be seen again from the surface's front, and its peak so near and so sharply that half of a rise
/// would be left; the rise is that of a peak of its shape. It is gone when the change counts and less than
/// half is left, and not observed where these temperatures are not there. What was gone and is found again is
/// new, as is a spot at its first sight: an alarm where the change from what was there counts, or nobody had
/// looked.
class HotspotHistory {
 public:
  /// Missions are to come in the order of their flights.
  void add(MissionSight sight);

  [[nodiscard]] const std::vector<MissionSight>& missions() const { return missions_; }
  [[nodiscard]] const std::vector<HotspotTrack>& tracks() const { return tracks_; }
  /// Of the tracks that one of the two missions saw; with their places in tracks().
  struct Difference {
    std::size_t track;
    HotspotChange change;
  };
  [[nodiscard]] std::vector<Difference> between(std::size_t from, std::size_t to) const;

 private:
  void begin(const Hotspot& spot);
  [[nodiscard]] std::optional<Estimate> deltaIn(const HotspotTrack& track, std::size_t mission) const;

  std::vector<MissionSight> missions_;
  std::vector<HotspotTrack> tracks_;
};

}  // namespace thermovox
