#include "calibration/mission_refinement.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibration/edge_agreement.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kFinest = kAlignmentLevels.size() - 1;
constexpr int kFewestEdges = 60;
constexpr std::size_t kFewestFrames = 8;
constexpr std::size_t kStretches = 10;  // of the mission, each in turn left out of the fit
constexpr double kSignificant = 3.0;    // sigmas
constexpr double kDoubted = 1.4;        // sigmas: directions in which less was found are left as they are
constexpr double kLeastGain = 0.02;     // of the cost
constexpr double kLeastMove = 0.15;     // px, rms over the edges: less is not worth a change
constexpr double kCommonError =
    0.07;                        // px: what edges may err by together, in whatever pattern (curved, blurred)
constexpr double kLocked = 1.5;  // times what edges agree by chance: less is no alignment
constexpr double kLost = 1.35;   // less than this, and the rig cannot be called consistent
constexpr double kTimeStep = 0.015;  // seconds; the stamps are first tried so far apart
constexpr int kTimeSteps = 10;       // either way
constexpr double kWeakTurn = 2.0 * std::numbers::pi / 180.0;  // radians
constexpr double kWeakMove = 0.03;                            // metres
constexpr double kWeakTime = 0.05;                            // seconds

/// What is tolerable of each unknown: 0.2 degrees, 5 mm, 5 ms. Directions are compared in these units.
EdgeChange tolerances() {
  const double turn = 0.2 * std::numbers::pi / 180.0;
  return (EdgeChange() << turn, turn, turn, 0.005, 0.005, 0.005, 0.005).finished();
}

/// Takes a beam's roll about itself out of rotations along the body's axes: it moves no return.
Eigen::Matrix3d withoutRoll(const Laser& laser) {
  if (laser.kind != LaserKind::beam) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d axis = laser.T_body_laser.rotation * Eigen::Vector3d::UnitX();
  return Eigen::Matrix3d::Identity() - axis * axis.transpose();
}

EdgeMatrix priorCovariance(const Laser& laser) {
  EdgeMatrix covariance = EdgeMatrix::Zero();
  if (laser.covariance_body_laser.isZero()) {
    covariance.topLeftCorner<3, 3>() = kWeakTurn * kWeakTurn * withoutRoll(laser);
    covariance.diagonal().segment<3>(3).setConstant(kWeakMove * kWeakMove);
  } else {
    covariance.topLeftCorner<6, 6>() = laser.covariance_body_laser;
  }
  // What has none, a beam's roll, is held.
  covariance.diagonal().head<6>() += 1e-6 * tolerances().head<6>().cwiseAbs2();
  covariance(6, 6) = kWeakTime * kWeakTime;
  return covariance;
}

/// The frames cut into stretches of one length, one after the other.
std::size_t stretchOf(std::size_t frame, std::size_t frames) {
  return frame * std::min(kStretches, frames) / frames;
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
    const EdgeChange near = fitWithout(kStretches, EdgeChange::Zero(), 0);
    const EdgeChange far = fitWithout(kStretches, bestStamps(), 0);
    const bool farther = agreementOf(scene_, far, kFinest) > agreementOf(scene_, near, kFinest);
    result_.change = farther ? far : near;
    for (int round = 0; round < 2; ++round) {
      inflate();
      result_.change = fitWithout(kStretches, result_.change, kFinest);
    }
    inflate();
  }

  /// In a turn a late frame is off by many pixels, more than edges are looked for: stamps are tried one by
  /// one.
  [[nodiscard]] EdgeChange bestStamps() const {
    EdgeChange best = EdgeChange::Zero();
    double most = agreementOf(scene_, best, 1);
    for (int step = -kTimeSteps; step <= kTimeSteps; ++step) {
      EdgeChange change = EdgeChange::Zero();
      change[6] = step * kTimeStep;
      const double agreement = agreementOf(scene_, change, 1);
      if (agreement > most) most = agreement, best = change;
    }
    return best;
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
    result_.lock = lockOf(scene_, result_.change);
    static constexpr std::array kNames{"rotation_x",    "rotation_y",    "rotation_z", "translation_x",
                                       "translation_y", "translation_z", "time_offset"};
    for (int i = 0; i < 7; ++i) {
      if (result_.sigma[i] > 0.7 * std::sqrt(prior_(i, i)))
        result_.undetermined.emplace_back(kNames[static_cast<std::size_t>(i)]);
    }
  }

  /// The change of the rig has to be significant in one direction at least, that of the stamps for itself.
  /// Each direction is followed by how sure it is, 1 - (k sigma / found)^2 (the positive part of W. James and
  /// C. Stein, 1961): what is not known is left as it is.
  void chooseDirections() {
    const Eigen::Matrix<double, 6, 1> unit = tolerances().head<6>();
    const Matrix6d to_unit = unit.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(to_unit * covariance_.topLeftCorner<6, 6>() *
                                                        to_unit);
    const Vector6d along = eigen.eigenvectors().transpose() * to_unit * result_.change.head<6>();
    const Vector6d significance = along.cwiseAbs().cwiseQuotient(eigen.eigenvalues().cwiseSqrt());
    Vector6d share = Vector6d::Zero();
    if (significance.maxCoeff() > kSignificant)
      share = (1.0 - (kDoubted / significance.array().max(kDoubted)).square()).matrix();
    const Matrix6d kept = eigen.eigenvectors() * share.asDiagonal() * eigen.eigenvectors().transpose();
    projection_.topLeftCorner<6, 6>() = unit.asDiagonal() * kept * to_unit;
    projection_(6, 6) = std::abs(result_.change[6]) > kSignificant * result_.sigma[6] ? 1.0 : 0.0;
    result_.applied = projection_ * result_.change;
  }

  /// Each stretch is looked at with what the others say.
  void testOnOthers() {
    if (result_.applied.isZero()) return;
    const std::size_t frames = scene_.frames.size(), count = std::min(kStretches, frames);
    std::vector<EdgeGain> gains(count);
    EdgeGain total;
    for (std::size_t stretch = 0; stretch < count; ++stretch) {
      const EdgeChange change = projection_ * fitWithout(stretch, result_.change, kFinest);
      for (std::size_t i = 0; i < frames; ++i) {
        if (stretchOf(i, frames) != stretch) continue;
        gains[stretch].add(before_[i], matchEdges(scene_, scene_.frames[i], change, kFinest));
      }
      total.before += gains[stretch].before, total.after += gains[stretch].after;
    }
    const auto n = static_cast<double>(count);
    const double mean = (total.before - total.after) / n;
    double squares = 0.0;
    for (const EdgeGain& gain : gains) squares += std::pow(gain.before - gain.after - mean, 2);
    result_.gain = (total.before - total.after) / std::max(total.before, 1e-9);
    result_.gain_sigma = std::sqrt(squares * n / (n - 1.0)) / std::max(total.before, 1e-9);
  }

  void decide() {
    const bool better = result_.gain > kLeastGain && result_.gain > kSignificant * result_.gain_sigma;
    const double move = moveOf(before_, result_.applied);
    if (!better || result_.lock < kLocked || move < kLeastMove) {
      if (move > kLeastMove) doubt(move);
      result_.applied.setZero();
    }
    EdgeChange of_rig = result_.applied;
    of_rig[6] = 0.0;
    result_.refined = moveOf(before_, of_rig) > kLeastMove;
    if (!result_.refined) result_.applied.head<6>().setZero(), of_rig.setZero();
    result_.consistent = result_.applied.isZero() && lockOf(scene_, EdgeChange::Zero()) > kLost;
    result_.rms_px_refined = robustRms(matchAll(scene_, result_.applied));
    result_.T_body_laser = changedPose(scene_.T_body_laser, of_rig);
    result_.covariance_body_laser = covarianceOf(of_rig.head<6>());
    warn();
  }

  /// Of what was applied: that of the estimate, and what of the estimate was not followed.
  [[nodiscard]] Matrix6d covarianceOf(const Vector6d& applied) const {
    const Vector6d left = result_.change.head<6>() - applied;
    Matrix6d keep = Matrix6d::Identity();
    keep.topLeftCorner<3, 3>() = withoutRoll(laser_);
    return keep * (covariance_.topLeftCorner<6, 6>() + left * left.transpose()) * keep.transpose();
  }

  void doubt(double move) {
    result_.warnings.push_back(fmt::format(
        "a change that moves edges by {:.1f} px was found and not followed: parts of the mission do not "
        "confirm what the others say (gain {:.0f} +- {:.0f} %); a longer mission may tell",
        move, 100.0 * result_.gain, 100.0 * result_.gain_sigma));
  }

  void warn() {
    if (!result_.consistent && result_.applied.isZero())
      result_.warnings.emplace_back(
          "the edges of depth and of temperature do not agree, and no change of the rig was found that "
          "brings them "
          "together for certain: check rig, lens, clocks and trajectory");
    if (!result_.refined || laser_.covariance_body_laser.isZero()) return;
    const EdgeChange known = prior_.diagonal().cwiseSqrt();
    const double most = result_.applied.head<6>().cwiseAbs().cwiseQuotient(known.head<6>()).maxCoeff();
    if (most > kSignificant)
      result_.warnings.push_back(fmt::format(
          "the change is {:.1f} times the sigma of covariance_body_laser: has the laser or the camera been "
          "moved since its calibration?",
          most));
  }

  const EdgeScene& scene_;
  const Laser& laser_;
  EdgeMatches before_, after_;
  EdgeMatrix prior_, covariance_ = EdgeMatrix::Zero();
  EdgeMatrix projection_ = EdgeMatrix::Zero();  ///< what of a change is followed
  AlignmentModel model_;
  MissionRefinement result_;
};

}  // namespace

MissionRefinement refineOnMission(const EdgeScene& scene, const Laser& laser) {
  return Refinement(scene, laser).run();
}

}  // namespace thermovox
