#include "calibration/mission_refinement.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kFinest = kAlignmentLevels.size() - 1;
constexpr int kFewestEdges = 60;
constexpr std::size_t kFewestFrames = 8;
constexpr std::size_t kStretches = 10;  // of the mission, each in turn left out of the fit
constexpr double kSignificant = 3.0;    // sigmas
constexpr double kFollowed = 1.5;       // sigmas: directions in which less was found are left as they are
constexpr double kLeastGain = 0.02;     // of the cost
constexpr double kLeastMove = 0.15;     // px, rms over the edges: less is not worth a change
constexpr double kCommonError = 0.07;    // px: what edges may err by together, in whatever pattern (curved, blurred)
constexpr double kWeakTurn = 2.0 * std::numbers::pi / 180.0;  // radians
constexpr double kWeakMove = 0.03;                            // metres
constexpr double kWeakTime = 0.05;                            // seconds

/// What is tolerable of each unknown: 0.2 degrees, 5 mm, 5 ms. Directions are compared in these units.
EdgeChange tolerances() {
  const double turn = 0.2 * std::numbers::pi / 180.0;
  return (EdgeChange() << turn, turn, turn, 0.005, 0.005, 0.005, 0.005).finished();
}

EdgeMatrix priorCovariance(const Laser& laser) {
  EdgeMatrix covariance = EdgeMatrix::Zero();
  if (laser.covariance_body_laser.isZero()) {
    covariance.diagonal().head<3>().setConstant(kWeakTurn * kWeakTurn);
    covariance.diagonal().segment<3>(3).setConstant(kWeakMove * kWeakMove);
  } else {
    covariance.topLeftCorner<6, 6>() = laser.covariance_body_laser;
    // A beam's roll has none: it is held.
    covariance.diagonal().head<6>() += 1e-6 * tolerances().head<6>().cwiseAbs2();
  }
  covariance(6, 6) = kWeakTime * kWeakTime;
  return covariance;
}

using Matches = std::vector<std::vector<EdgeMatch>>;  // of each frame

Matches matchAll(const EdgeScene& scene, const EdgeChange& change) {
  Matches matches;
  for (const EdgeFrame& frame : scene.frames) matches.push_back(matchEdges(scene, frame, change, kFinest));
  return matches;
}

double robustRms(const Matches& all) {
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

/// What the edges say together of one shift that all of them have, 1 / px^2.
double informationOfPlace(const Matches& all) {
  double information = 0.0;
  for (const auto& matches : all) {
    for (const EdgeMatch& match : matches)
      if (match.matched) information += match.weight() / (match.sigma_px * match.sigma_px);
  }
  return information;
}

/// The frames cut into stretches of one length, one after the other.
std::size_t stretchOf(std::size_t frame, std::size_t frames) {
  return frame * std::min(kStretches, frames) / frames;
}

/// How the cost of a stretch changes.
struct StretchGain {
  double before = 0.0, after = 0.0;
};

/// Over the edges in view both before and after.
void addGain(const std::vector<EdgeMatch>& before, const std::vector<EdgeMatch>& after, StretchGain& gain) {
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!before[i].in_view || !after[i].in_view || !(before[i].matched || after[i].matched)) continue;
    gain.before += before[i].cost();
    gain.after += after[i].cost();
  }
}

/// The one estimate, and what it is tested by.
class Refinement {
 public:
  Refinement(const EdgeScene& scene, const Laser& laser)
      : scene_(scene), laser_(laser), before_(matchAll(scene, EdgeChange::Zero())) {
    prior_ = priorCovariance(laser);
    model_.prior_information = prior_.inverse();
    countEdges();
  }

  MissionRefinement run() {
    fit();
    describeEstimate();
    chooseDirections();
    testOnOthers();
    decide();
    return std::move(result_);
  }

 private:
  void countEdges() {
    for (const auto& matches : before_) {
      const auto matched =
          std::count_if(matches.begin(), matches.end(), [](const EdgeMatch& m) { return m.matched; });
      result_.edges += static_cast<int>(matched);
      result_.frames += matched > 0 ? 1 : 0;
    }
    if (result_.edges >= kFewestEdges && scene_.frames.size() >= kFewestFrames) return;
    throw UnobservableError(
        fmt::format("no temperature edges at depth edges enough to check the rig by: found {} in {} frames, "
                    "expected {} in {}; "
                    "a longer mission past objects warmer or colder than what is behind them is needed",
                    result_.edges, result_.frames, kFewestEdges, kFewestFrames));
  }

  [[nodiscard]] EdgeChange fitWithout(std::size_t stretch, const EdgeChange& start, std::size_t level) const {
    std::vector<char> used(scene_.frames.size(), 1);
    for (std::size_t i = 0; i < used.size(); ++i) used[i] = stretchOf(i, used.size()) == stretch ? 0 : 1;
    return alignEdges(scene_, model_, start, level, used);
  }

  /// Twice: how far the edges err together is known only after a first fit.
  void fit() {
    result_.change = fitWithout(kStretches, EdgeChange::Zero(), 0);
    for (int round = 0; round < 2; ++round) {
      inflate();
      result_.change = fitWithout(kStretches, result_.change, kFinest);
    }
    inflate();
  }

  /// By the spread of the stretches' gradients (the middle of the "sandwich" of H. White, 1982).
  void inflate() {
    const std::size_t frames = scene_.frames.size(), count = std::min(kStretches, frames);
    std::vector<EdgeTerms> terms(count);
    after_ = matchAll(scene_, result_.change);
    for (std::size_t i = 0; i < frames; ++i) terms[stretchOf(i, frames)] += edgeTerms(after_[i]);
    EdgeTerms sum;
    for (const EdgeTerms& term : terms) sum += term;
    EdgeMatrix spread = EdgeMatrix::Zero();
    const auto n = static_cast<double>(count);
    for (const EdgeTerms& term : terms) {
      const EdgeChange off = term.gradient - sum.gradient / n;
      spread += off * off.transpose() * (n / (n - 1.0));
    }
    const EdgeMatrix inverse = (sum.information + model_.prior_information).inverse();
    const double shared = (inverse * sum.information).trace();
    model_.inflation = std::max(1.0, (inverse * spread).trace() / std::max(shared, 1e-9)) +
                       kCommonError * kCommonError * informationOfPlace(after_);
    covariance_ = (sum.information / model_.inflation + model_.prior_information).inverse();
  }

  void describeEstimate() {
    result_.sigma = covariance_.diagonal().cwiseSqrt();
    result_.rms_px = robustRms(before_);
    static constexpr std::array kNames{"rotation_x",    "rotation_y",    "rotation_z", "translation_x",
                                       "translation_y", "translation_z", "time_offset"};
    for (int i = 0; i < 7; ++i) {
      if (result_.sigma[i] > 0.7 * std::sqrt(prior_(i, i)))
        result_.undetermined.emplace_back(kNames[static_cast<std::size_t>(i)]);
    }
  }

  /// The change has to be significant in one direction at least. It is followed in those in which it is more
  /// likely than not an improvement; what is not known is left as it is.
  void chooseDirections() {
    const EdgeChange unit = tolerances();
    const EdgeMatrix scaled = unit.cwiseInverse().asDiagonal() * covariance_ * unit.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<EdgeMatrix> eigen(scaled);
    const EdgeChange along = eigen.eigenvectors().transpose() * result_.change.cwiseQuotient(unit);
    const EdgeChange significance = along.cwiseAbs().cwiseQuotient(eigen.eigenvalues().cwiseSqrt());
    if (significance.maxCoeff() < kSignificant) return;
    EdgeMatrix kept = EdgeMatrix::Zero();
    for (int i = 0; i < 7; ++i) {
      if (significance[i] > kFollowed)
        kept += eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
    }
    projection_ = unit.asDiagonal() * kept * unit.cwiseInverse().asDiagonal();
    result_.applied = projection_ * result_.change;
  }

  /// Each stretch is looked at with what the others say.
  void testOnOthers() {
    if (result_.applied.isZero()) return;
    const std::size_t frames = scene_.frames.size(), count = std::min(kStretches, frames);
    std::vector<StretchGain> gains(count);
    StretchGain total;
    for (std::size_t stretch = 0; stretch < count; ++stretch) {
      const EdgeChange change = projection_ * fitWithout(stretch, result_.change, kFinest);
      for (std::size_t i = 0; i < frames; ++i) {
        if (stretchOf(i, frames) != stretch) continue;
        addGain(before_[i], matchEdges(scene_, scene_.frames[i], change, kFinest), gains[stretch]);
      }
      total.before += gains[stretch].before, total.after += gains[stretch].after;
    }
    const auto n = static_cast<double>(count);
    const double mean = (total.before - total.after) / n;
    double squares = 0.0;
    for (const StretchGain& gain : gains) squares += std::pow(gain.before - gain.after - mean, 2);
    result_.gain = (total.before - total.after) / std::max(total.before, 1e-9);
    result_.gain_sigma = std::sqrt(squares * n / (n - 1.0)) / std::max(total.before, 1e-9);
  }

  [[nodiscard]] double moveOf(const EdgeChange& change) const {
    double squares = 0.0;
    int count = 0;
    for (const auto& matches : before_) {
      for (const EdgeMatch& match : matches) {
        if (!match.matched) continue;
        const double move = match.jacobian * change;
        squares += move * move, ++count;
      }
    }
    return std::sqrt(squares / std::max(1, count));
  }

  void decide() {
    const bool better = result_.gain > kLeastGain && result_.gain > kSignificant * result_.gain_sigma;
    if (!better || moveOf(result_.applied) < kLeastMove) result_.applied.setZero();
    result_.consistent = result_.applied.isZero();
    EdgeChange of_rig = result_.applied;
    of_rig[6] = 0.0;
    result_.refined = moveOf(of_rig) > kLeastMove;
    if (!result_.refined) of_rig.setZero();
    result_.rms_px_refined = robustRms(matchAll(scene_, result_.applied));
    result_.T_body_laser = changedPose(scene_.T_body_laser, of_rig);
    result_.covariance_body_laser = covariance_.topLeftCorner<6, 6>();
  }

  const EdgeScene& scene_;
  const Laser& laser_;
  Matches before_, after_;
  EdgeMatrix prior_, covariance_ = EdgeMatrix::Zero();
  EdgeMatrix projection_ = EdgeMatrix::Zero();  ///< onto the directions that are followed
  AlignmentModel model_;
  MissionRefinement result_;
};

}  // namespace

MissionRefinement refineOnMission(const EdgeScene& scene, const Laser& laser) {
  return Refinement(scene, laser).run();
}

}  // namespace thermovox
