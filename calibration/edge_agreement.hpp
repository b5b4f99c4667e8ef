#pragma once

#include <vector>

#include "calibration/edge_alignment.hpp"

namespace thermovox {

/// The matches of each frame's edges at the finest level.
using EdgeMatches = std::vector<std::vector<EdgeMatch>>;

[[nodiscard]] EdgeMatches matchAll(const EdgeScene& scene, const EdgeChange& change);

/// Of the matched edges, by robust weights, px.
[[nodiscard]] double robustRms(const EdgeMatches& all);

/// Root mean square of what a change moves the matched edges across themselves, px.
[[nodiscard]] double moveOf(const EdgeMatches& all, const EdgeChange& change);

/// What the edges say together of one shift that all of them have, 1 / px^2.
[[nodiscard]] double informationOfPlace(const EdgeMatches& all);

/// How well depth edges and edges of temperature agree: 1 less the mean cost of the edges in view.
[[nodiscard]] double agreementOf(const EdgeScene& scene, const EdgeChange& change, std::size_t level);

/// The same over what it is by chance (the camera turned away by some pixels, the mean of four ways): well
/// over 1 where the edges are at their places.
[[nodiscard]] double lockOf(const EdgeScene& scene, const EdgeChange& change);

/// The cost of some edges, with two changes.
struct EdgeGain {
  double before = 0.0;
  double after = 0.0;

  /// Counts the edges in view with both, and matched with one at least.
  void add(const std::vector<EdgeMatch>& with_first, const std::vector<EdgeMatch>& with_second);
};

}  // namespace thermovox
