#include "calibration/edge_agreement.hpp"

#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

constexpr std::size_t kFinest = kAlignmentLevels.size() - 1;
constexpr double kElsewhere = 7.0;  // px: edges so far off agree by chance alone

}  // namespace

EdgeMatches matchAll(const EdgeScene& scene, const EdgeChange& change) {
  EdgeMatches matches;
  for (const EdgeFrame& frame : scene.frames) matches.push_back(matchEdges(scene, frame, change, kFinest));
  return matches;
}

double robustRms(const EdgeMatches& all) {
  double squares = 0.0, weights = 0.0;
  for (const auto& matches : all) {
    for (const EdgeMatch& match : matches) {
      if (!match.matched) continue;
      squares += match.weight() * match.residual_px * match.residual_px;
      weights += match.weight();
    }
  }
  return weights > 0.0 ? std::sqrt(squares / weights) : 0.0;
}

double moveOf(const EdgeMatches& all, const EdgeChange& change) {
  double squares = 0.0;
  int count = 0;
  for (const auto& matches : all) {
    for (const EdgeMatch& match : matches) {
      if (!match.matched) continue;
      const double move = match.jacobian * change;
      squares += move * move;
      ++count;
    }
  }
  return std::sqrt(squares / std::max(1, count));
}

double informationOfPlace(const EdgeMatches& all) {
  double information = 0.0;
  for (const auto& matches : all) {
    for (const EdgeMatch& match : matches) {
      if (match.matched) information += match.weight() / (match.sigma_px * match.sigma_px);
    }
  }
  return information;
}

double agreementOf(const EdgeScene& scene, const EdgeChange& change, std::size_t level) {
  double agreement = 0.0;
  int count = 0;
  for (const EdgeFrame& frame : scene.frames) {
    for (const EdgeMatch& match : matchEdges(scene, frame, change, level)) {
      agreement += 1.0 - match.cost();
      count += match.in_view ? 1 : 0;
    }
  }
  return agreement / std::max(1, count);
}

double lockOf(const EdgeScene& scene, const EdgeChange& change) {
  const double turn = kElsewhere / std::min(scene.camera.fx(), scene.camera.fy());
  double by_chance = 0.0;
  for (const double side : {-turn, turn}) {
    for (const int axis : {0, 1}) {
      EdgeChange turned = change;
      turned.head<3>() += side * scene.T_body_camera.matrix().col(axis);
      by_chance += agreementOf(scene, turned, kFinest) / 4.0;
    }
  }
  return agreementOf(scene, change, kFinest) / std::max(by_chance, 1e-6);
}

void EdgeGain::add(const std::vector<EdgeMatch>& with_first, const std::vector<EdgeMatch>& with_second) {
  for (std::size_t i = 0; i < with_first.size(); ++i) {
    const EdgeMatch &first = with_first[i], &second = with_second[i];
    if (!first.in_view || !second.in_view || !(first.matched || second.matched)) continue;
    before += first.cost();
    after += second.cost();
  }
}

}  // namespace thermovox
