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

/// Samples within a radius of a place that were seen from the front of the spot's surface.
std::vector<std::uint32_t> seenNear(const MissionSight& sight, const Eigen::Vector3d& p_world, double radius,
                                    const Hotspot& spot) {
  std::vector<std::uint32_t> near = sight.layer->within(p_world, radius);
  std::erase_if(near, [&](std::uint32_t i) {
    return !blurOf((*sight.layer)[i], spot.normal, sight.camera).fromTheFront();
  });
  return near;
}

/// Whether a mission's temperatures cover the cells of a spot.
bool sawCells(const MissionSight& sight, const Hotspot& spot) {
  const double edge = sight.layer->resolution();
  std::size_t seen = 0;
  for (const CellKey& key : spot.cells) {
    const Eigen::Vector3d centre = (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5) * edge;
    if (!seenNear(sight, centre, 1.5 * edge, spot).empty()) ++seen;
  }
  return static_cast<double>(seen) >= kSeenAgain * static_cast<double>(spot.cells.size());
}

/// By how much a mission found the place of a spot warmer than its surroundings: the warmest of the cells at
/// the peak, sharpened as a peak of the spot's width would have to be. None where nobody could tell.
std::optional<Estimate> excessAt(const MissionSight& sight, const Hotspot& spot) {
  const SurfaceLayer& layer = *sight.layer;
  if (!sawCells(sight, spot)) return std::nullopt;
  const double width = widthOf(spot, layer.resolution());
  const std::vector<std::uint32_t> here =
      seenNear(sight, spot.position.p_world, std::max(0.5 * width, 1.5 * layer.resolution()), spot);
  if (here.empty()) return std::nullopt;
  const std::uint32_t warmest = *std::max_element(
      here.begin(), here.end(),
      [&](std::uint32_t a, std::uint32_t b) { return layer[a].celsius < layer[b].celsius; });
  const double gap = std::max(kGap, 2.0 * spot.width);
  const auto reference = localReference(layer, here, gap, std::vector<bool>(layer.samples().size()));
  const PeakModel unit{.rise = 1.0, .width = width};
  const double left = unit.at(unit.centre, blurOf(layer[warmest], spot.normal, sight.camera));
  if (!reference || left < kLeastLeft) return std::nullopt;
  return Estimate{(layer[warmest].celsius - reference->celsius) / left,
                  std::hypot(static_cast<double>(layer[warmest].sigma), reference->sigma) / left};
}

/// Mean over the missions up to `last` that saw the spot since its last change; those that read low only
/// where there is no other.
Estimate deltaSinceChange(const HotspotTrack& track, std::size_t last) {
  double weights = 0.0, sum = 0.0;
  for (std::size_t mission = last + 1; mission-- > 0;) {
    const std::optional<Hotspot>& spot = track.seen[mission];
    if (spot && !spot->reads_low) {
      const double weight = 1.0 / (spot->delta.sigma * spot->delta.sigma);
      weights += weight;
      sum += weight * spot->delta.value;
    }
    if (spot && track.changes[mission]->state != HotspotState::steady) break;
  }
  if (!(weights > 0.0)) return track.seen[last]->delta;
  return {sum / weights, 1.0 / std::sqrt(weights)};
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
    const std::size_t before = track.lastSeen();
    track.seen.emplace_back();
    if (assigned[i]) {
      const auto j = static_cast<std::size_t>(*assigned[i]);
      known[j] = true;
      track.seen.back() = now.hotspots[j];
    }
    track.changes.emplace_back(
        changeOf(track, deltaSinceChange(track, before), before, missions_.size() - 1));
  }
  for (std::size_t j = 0; j < now.hotspots.size(); ++j) {
    if (known[j]) continue;
    HotspotTrack track{.id = static_cast<int>(tracks_.size()) + 1};
    track.seen.resize(missions_.size());
    track.changes.resize(missions_.size());
    track.seen.back() = now.hotspots[j];
    track.changes.back() = HotspotChange{
        .to = now.hotspots[j].delta, .state = HotspotState::fresh, .alarm = missions_.size() > 1};
    tracks_.push_back(std::move(track));
  }
}

std::optional<Estimate> HotspotHistory::deltaIn(const HotspotTrack& track, std::size_t mission) const {
  if (track.seen[mission]) return track.seen[mission]->delta;
  return excessAt(missions_[mission], *track.seen[track.lastSeen()]);
}

HotspotChange HotspotHistory::changeOf(const HotspotTrack& track, const std::optional<Estimate>& before,
                                       std::size_t from, std::size_t to) const {
  HotspotChange change{.from = before, .to = deltaIn(track, to)};
  const bool known = change.from && change.to;
  if (known) {
    const double shape = kShapeError * std::max(change.from->value, change.to->value);
    change.change = {change.to->value - change.from->value,
                     std::hypot(change.from->sigma, change.to->sigma, shape)};
  }
  // What reads low is a bound: a spot may have risen above it, but not fallen below.
  const std::size_t lower = change.change.value > 0.0 ? from : to;
  const bool is_bound = track.seen[lower] && track.seen[lower]->reads_low;
  const bool counts =
      !is_bound && std::abs(change.change.value) >= kLeastChange && change.significance() >= kSure;
  const bool found = track.seen[to].has_value();
  if (!change.to) {
    change.state = HotspotState::not_observed;
  } else if (found && !track.seen[from]) {
    change.state = HotspotState::fresh;
    change.alarm = !change.from || counts;
  } else if (!found && (!known || (counts && change.to->value < kGone * change.from->value))) {
    change.state = HotspotState::gone;
  } else if (counts) {
    change.state = change.change.value > 0.0 ? HotspotState::growing : HotspotState::cooling;
    change.alarm = change.change.value > 0.0;
  }
  return change;
}

std::vector<HotspotHistory::Difference> HotspotHistory::between(std::size_t from, std::size_t to) const {
  std::vector<Difference> differences;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!tracks_[i].seen[from] && !tracks_[i].seen[to]) continue;
    differences.push_back({i, changeOf(tracks_[i], deltaIn(tracks_[i], from), from, to)});
  }
  return differences;
}

}  // namespace thermovox
