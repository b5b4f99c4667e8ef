#include "mapping/hotspot_history.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/assignment.hpp"
#include "mapping/hot_clusters.hpp"
#include "mapping/peak_model.hpp"

namespace thermovox {
namespace {

constexpr double kGate = 16.27;       // chi squared, 3 degrees of freedom, 99.9 %
constexpr double kFarthest = 0.5;     // metres
constexpr double kSizeSigma = 0.5;    // of the logarithm of a width
constexpr double kSeenAgain = 0.5;    // of its cells
constexpr double kLeastLeft = 0.5;    // of a rise that blur may leave
constexpr double kGone = 0.5;         // of a delta that is left of a spot that is gone
constexpr double kLeastChange = 2.0;  // C
constexpr double kSure = 3.5;         // sigmas: one of two thousand comparisons is wrong
constexpr double kGap = 0.15;         // metres between a spot and its surroundings
constexpr double kShapeError = 0.01;  // of a delta: what one spot seen twice differs by for its shape
constexpr double kExcessError = 0.1;  // of a rise that was not found as a hot spot, but looked for
constexpr double kCellError = 0.5;    // C, of a cell beside its own sigma

double widthOf(const Hotspot& spot, double resolution) {
  return std::max(spot.width, resolution);
}

/// Infinite where the two cannot be one.
double costOf(const Hotspot& a, const Hotspot& b, double resolution) {
  const Eigen::Vector3d apart = b.position.p_world - a.position.p_world;
  const double width_a = widthOf(a, resolution), width_b = widthOf(b, resolution);
  if (apart.norm() > kFarthest) return std::numeric_limits<double>::infinity();
  const double slack = 0.5 * std::max(width_a, width_b);
  const Eigen::Matrix3d covariance =
      a.position.covariance() + b.position.covariance() + slack * slack * Eigen::Matrix3d::Identity();
  const double size = std::log(width_a / width_b) / kSizeSigma;
  const bool both_fitted = a.width > 0.0 && b.width > 0.0;
  return apart.dot(covariance.ldlt().solve(apart)) + (both_fitted ? size * size : 0.0);
}

/// Whether a mission's temperatures cover the cells of a spot, seen from the front of its surface.
bool sawCells(const MissionSight& sight, const Hotspot& spot) {
  const double edge = sight.layer->resolution();
  const auto isSeen = [&](const CellKey& key) {
    const Eigen::Vector3d centre = (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5) * edge;
    const std::vector<std::uint32_t> near = sight.layer->within(centre, 1.5 * edge);
    return std::any_of(near.begin(), near.end(), [&](std::uint32_t i) {
      return blurOf((*sight.layer)[i], spot.normal, sight.camera).fromTheFront();
    });
  };
  const auto seen = std::count_if(spot.cells.begin(), spot.cells.end(), isSeen);
  return static_cast<double>(seen) >= kSeenAgain * static_cast<double>(spot.cells.size());
}

/// A sample near a spot, and how much of a rise of the spot's shape is there.
struct ShareSample {
  std::uint32_t index;
  double share;
};

/// Those in reach of the peak that are seen from the front. Missions may be off each other along the normal.
std::vector<ShareSample> sharesAround(const MissionSight& sight, const Hotspot& spot) {
  const double width = widthOf(spot, sight.layer->resolution());
  const PeakModel unit{.centre = spot.position.p_world, .rise = 1.0, .width = width};
  std::vector<ShareSample> shares;
  for (const std::uint32_t i :
       sight.layer->within(unit.centre, std::max(width, 1.5 * sight.layer->resolution()))) {
    const SurfaceSample& sample = (*sight.layer)[i];
    const SurfaceBlur blur = blurOf(sample, spot.normal, sight.camera);
    if (!blur.fromTheFront()) continue;
    const double off = spot.normal.dot(sample.p_world - unit.centre);
    shares.push_back({i, unit.at(sample.p_world - off * spot.normal, blur)});
  }
  return shares;
}

/// By how much a mission found the place of a spot warmer than its surroundings: the rise of a peak of the
/// spot's shape that fits the temperatures there best. None where nobody could tell: where too few of its
/// cells were seen, or none of them so sharply and so near the peak that half of a rise would be left.
std::optional<Estimate> excessAt(const MissionSight& sight, const Hotspot& spot) {
  const SurfaceLayer& layer = *sight.layer;
  if (!sawCells(sight, spot)) return std::nullopt;
  const std::vector<ShareSample> shares = sharesAround(sight, spot);
  const auto most = [](const ShareSample& a, const ShareSample& b) { return a.share < b.share; };
  const auto at_peak = std::max_element(shares.begin(), shares.end(), most);
  if (at_peak == shares.end() || at_peak->share < kLeastLeft) return std::nullopt;
  std::vector<std::uint32_t> here;
  for (const ShareSample& sample : shares) here.push_back(sample.index);
  const auto reference = localReference(layer, here, std::max(kGap, 2.0 * spot.width),
                                        std::vector<bool>(layer.samples().size()));
  if (!reference) return std::nullopt;
  double information = 0.0, sum = 0.0, shared = 0.0;
  for (const auto& [i, share] : shares) {
    const double weight = 1.0 / (std::pow(layer[i].sigma, 2) + kCellError * kCellError);
    information += weight * share * share;
    sum += weight * share * (layer[i].celsius - reference->celsius);
    shared += weight * share;
  }
  const double rise = sum / information;
  double squares = 0.0;
  for (const auto& [i, share] : shares) {
    squares += std::pow(layer[i].celsius - reference->celsius - rise * share, 2) /
               (std::pow(layer[i].sigma, 2) + kCellError * kCellError);
  }
  const double scatter = std::max(1.0, squares / std::max(static_cast<double>(shares.size()) - 1.0, 1.0));
  return Estimate{rise, std::hypot(std::sqrt(scatter / information), reference->sigma * shared / information,
                                   kExcessError * rise)};
}

/// What a spot was before a mission.
struct Before {
  std::optional<Estimate> delta;  ///< C; none where nobody looked
  bool is_bound = false;          ///< it may have been more
  bool was_hot = false;           ///< as a hot spot; false also for one that is gone
};

/// Mean over the missions up to `last` that saw the spot since its last change; those that are bounds only
/// where there is no other.
Before sinceLastChange(const HotspotTrack& track, std::size_t last) {
  double weights = 0.0, sum = 0.0;
  for (std::size_t mission = last + 1; mission-- > 0;) {
    const std::optional<Hotspot>& spot = track.seen[mission];
    if (spot && !spot->is_bound) {
      const double weight = 1.0 / (spot->delta.sigma * spot->delta.sigma);
      weights += weight;
      sum += weight * spot->delta.value;
    }
    if (spot && track.changes[mission]->state != HotspotState::steady) break;
  }
  if (!(weights > 0.0)) return {track.seen[track.lastSeen()]->delta, true, true};
  return {Estimate{sum / weights, 1.0 / std::sqrt(weights)}, false, true};
}

/// Of a track, before the mission that comes after all its changes.
Before beforeNow(const HotspotTrack& track) {
  for (std::size_t mission = track.changes.size(); mission-- > 0;) {
    const std::optional<HotspotChange>& change = track.changes[mission];
    if (!change || change->state == HotspotState::not_observed) continue;
    if (change->state == HotspotState::gone) return {change->to, false, false};
    return sinceLastChange(track, mission);
  }
  return {};
}

HotspotChange changeBetween(const Before& before, const std::optional<Estimate>& now,
                            const std::optional<Hotspot>& found) {
  HotspotChange change{.from = before.delta, .to = now};
  if (change.from && change.to) {
    const double shape = kShapeError * std::max(change.from->value, change.to->value);
    change.change = {change.to->value - change.from->value,
                     std::hypot(change.from->sigma, change.to->sigma, shape)};
  }
  // A rise from a bound may be none, and so may a fall to one.
  const bool rises = change.change.value > 0.0;
  const bool is_bound = rises ? before.is_bound : found && found->is_bound;
  const bool counts =
      !is_bound && std::abs(change.change.value) >= kLeastChange && change.significance() >= kSure;
  if (!change.to) {
    change.state = HotspotState::not_observed;
  } else if (found && !before.was_hot) {
    change.state = HotspotState::fresh;
    change.alarm = !change.from || (counts && rises);
  } else if (!found && (!before.was_hot || (counts && change.to->value < kGone * change.from->value))) {
    change.state = HotspotState::gone;
  } else if (counts) {
    change.state = rises ? HotspotState::growing : HotspotState::cooling;
    change.alarm = rises;
  }
  return change;
}

}  // namespace

const char* nameOf(HotspotState state) {
  constexpr const char* names[] = {"new", "growing", "steady", "cooling", "gone", "not_observed"};
  return names[static_cast<std::size_t>(state)];
}

double HotspotChange::significance() const {
  return change.sigma > 0.0 ? std::abs(change.value) / change.sigma : 0.0;
}

std::size_t HotspotTrack::lastSeen() const {
  std::size_t last = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i]) last = i;
  }
  return last;
}

void HotspotHistory::add(MissionSight sight) {
  missions_.push_back(std::move(sight));
  const MissionSight& now = missions_.back();
  Eigen::MatrixXd costs(tracks_.size(), now.hotspots.size());
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Hotspot& known = *tracks_[i].seen[tracks_[i].lastSeen()];
    for (std::size_t j = 0; j < now.hotspots.size(); ++j) {
      costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          costOf(known, now.hotspots[j], now.layer->resolution());
    }
  }
  const std::vector<std::optional<int>> assigned = assign(costs, kGate);
  std::vector<bool> known(now.hotspots.size());
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    HotspotTrack& track = tracks_[i];
    const Before before = beforeNow(track);
    track.seen.emplace_back();
    if (assigned[i]) {
      const auto j = static_cast<std::size_t>(*assigned[i]);
      known[j] = true;
      track.seen.back() = now.hotspots[j];
    }
    track.changes.emplace_back(
        changeBetween(before, deltaIn(track, missions_.size() - 1), track.seen.back()));
  }
  for (std::size_t j = 0; j < now.hotspots.size(); ++j) {
    if (!known[j]) begin(now.hotspots[j]);
  }
}

void HotspotHistory::begin(const Hotspot& spot) {
  HotspotTrack track{.id = static_cast<int>(tracks_.size()) + 1};
  track.seen.resize(missions_.size());
  track.changes.resize(missions_.size());
  track.seen.back() = spot;
  Before before;  // by the last mission that looked
  for (std::size_t mission = missions_.size() - 1; mission-- > 0 && !before.delta;) {
    before.delta = excessAt(missions_[mission], spot);
  }
  HotspotChange change = changeBetween(before, spot.delta, spot);
  change.alarm &= missions_.size() > 1;
  track.changes.back() = change;
  tracks_.push_back(std::move(track));
}

std::optional<Estimate> HotspotHistory::deltaIn(const HotspotTrack& track, std::size_t mission) const {
  if (track.seen[mission]) return track.seen[mission]->delta;
  return excessAt(missions_[mission], *track.seen[track.lastSeen()]);
}

std::vector<HotspotHistory::Difference> HotspotHistory::between(std::size_t from, std::size_t to) const {
  std::vector<Difference> differences;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const std::optional<Hotspot>&before = tracks_[i].seen[from], &now = tracks_[i].seen[to];
    if (!before && !now) continue;
    differences.push_back(
        {i, changeBetween({deltaIn(tracks_[i], from), before && before->is_bound, before.has_value()},
                          deltaIn(tracks_[i], to), now)});
  }
  return differences;
}

}  // namespace thermovox
