#include "calibration/rig_calibration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "calibration/board_edges.hpp"
#include "calibration/board_points.hpp"
#include "calibration/board_search.hpp"
#include "calibration/bundle_statistics.hpp"
#include "calibration/camera_start.hpp"
#include "calibration/capture_selection.hpp"
#include "calibration/free_intrinsics.hpp"
#include "calibration/laser_sights.hpp"
#include "calibration/laser_start.hpp"
#include "calibration/noise_model.hpp"
#include "calibration/residual_summary.hpp"
#include "calibration/verdict_words.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kInset = 0.01;         // metres from the plate's edge: mixed returns
constexpr double kSlack = 0.03;         // metres off the plane, and five sigmas of the laser
constexpr double kWellExplained = 0.3;  // mean cost of a start, 0 to 1, that needs no wider search
constexpr int kSelectionRounds = 3;     // of planes and which of them count
constexpr int kBundleRounds = 2;        // of planes, edges and the bundle

class Calibrator {
 public:
  Calibrator(const CalibrationInput& input, const CalibrationOptions& options)
      : input_(input), options_(options) {}

  RigCalibration run();

 private:
  void tell(const std::string& stage, double done) const {
    if (options_.progress) options_.progress(stage, done);
  }
  void startFromCameras();
  void fitCameras();
  [[nodiscard]] BundleFit withThirdRadial(BundleFit fit);
  void calibrateLaser();
  [[nodiscard]] std::optional<LaserStart> findLaser();
  enum class EdgesToo { no, yes };
  void takePlanes(const RigEstimate& estimate, EdgesToo edges);
  [[nodiscard]] std::vector<CaptureSight> captureSights() const;
  void fitTogether(RigEstimate estimate);
  void dropCaptures(const CaptureSelection& selection, const RigEstimate& estimate);
  void refuseLaser(const std::string& reason);
  void judge();
  void judgeCameras(const Linearisation& linear, const Eigen::MatrixXd& covariance);
  void judgeLaser(const Linearisation& linear, const Eigen::MatrixXd& covariance);

  const CalibrationInput& input_;
  const CalibrationOptions& options_;
  RigCalibration result_;
  BundleModel model_;
  BundleData data_;
  std::vector<std::optional<PlaneMoments>> planes_;  ///< of each capture, found without its neighbours
  std::vector<bool> counts_;                         ///< of each capture, for the laser
  std::vector<Matrix6d> board_covariances_;          ///< of each capture's board, by the images alone
};

void Calibrator::startFromCameras() {
  tell("cameras", 0.0);
  CameraStart start = startCameras(input_);
  result_.estimate = std::move(start.estimate);
  result_.captures = std::move(start.captures);
  result_.dropped = std::move(start.dropped);
  data_.points = boardPoints(input_.board);
  if (input_.laser) {
    data_.laser = input_.laser->kind;
    model_.common_range_bias_sigma = input_.laser->range_bias_sigma;
  }
  std::vector<std::size_t> views(input_.cameras.size(), 0);
  for (const BoardCapture& capture : result_.captures) {
    CaptureObservations seen;
    for (std::size_t camera = 0; camera < capture.views.size(); ++camera) {
      if (!capture.views[camera]) continue;
      ++views[camera];
      for (const CornerObservation& corner : cornersOf(*capture.views[camera], static_cast<int>(camera)))
        seen.corners.push_back(corner);
    }
    data_.captures.push_back(std::move(seen));
  }
  for (std::size_t camera = 0; camera < input_.cameras.size(); ++camera) {
    model_.free_intrinsics.push_back(freeIntrinsics(input_.cameras[camera], views[camera]));
    model_.corner_factor.push_back(1.0);
    result_.cameras.emplace_back();
    result_.cameras.back().views = static_cast<int>(views[camera]);
  }
}

/// Frees k3 where the corners fit so much better with it that chance does not explain it (1 in 1000).
BundleFit Calibrator::withThirdRadial(BundleFit fit) {
  constexpr double kBetter = 10.8;  // of the sum of squares
  for (std::size_t camera = 0; camera < input_.cameras.size(); ++camera) {
    const Intrinsics& lens = input_.cameras[camera].intrinsics;
    std::vector<int>& free = model_.free_intrinsics[camera];
    if (lens.model != LensModel::brown_conrady || lens.distortion_count < 5 || free.empty()) continue;
    free.push_back(kDistortion + 4);
    const BundleFit more = solveBundle(data_, fit.estimate, model_);
    if (2.0 * (fit.cost - more.cost) > kBetter) {
      fit = more;
    } else {
      free.pop_back();
    }
  }
  return fit;
}

void Calibrator::fitCameras() {
  tell("cameras", 0.5);
  model_.corner_loss = BundleModel::Loss::huber;
  BundleFit fit = solveBundle(data_, result_.estimate, model_);
  const std::vector<int> outliers = dropCornerOutliers(data_, fit.estimate, model_);
  for (std::size_t i = 0; i < outliers.size(); ++i) result_.cameras[i].corner_outliers = outliers[i];
  model_.corner_loss = BundleModel::Loss::none;
  fit = withThirdRadial(fitWithNoise(data_, fit.estimate, model_));
  result_.estimate = fit.estimate;
  const Linearisation linear = linearise(data_, fit.estimate, model_);
  const Eigen::MatrixXd covariance = jointCovariance(linear).covariance;
  for (const int place : linear.layout.board) {
    const bool known = place >= 0 && covariance.size() > 0;
    board_covariances_.push_back(known ? Matrix6d(covariance.block<6, 6>(place, place)) : Matrix6d::Zero());
  }
}

/// First near the guess; where that explains too little, anywhere.
std::optional<LaserStart> Calibrator::findLaser() {
  std::optional<LaserStart> best;
  std::vector<LaserSight> best_sights;
  for (const SearchWhere where : {SearchWhere::near_guess, SearchWhere::anywhere}) {
    std::vector<LaserSight> found =
        laserSights(input_, result_.captures, result_.estimate.T_reference_board, where, options_.progress);
    std::optional<LaserStart> start =
        startLaser(found, data_.laser, input_.laser->T_reference_laser, plateOf(input_.board));
    if (start && (!best || start->cost < best->cost)) {
      best = std::move(start);
      best_sights = std::move(found);
    }
    if (data_.laser != LaserKind::cloud || (best && best->cost < kWellExplained && !best->rival)) break;
  }
  planes_.assign(result_.captures.size(), std::nullopt);
  for (std::size_t i = 0; best && i < best_sights.size(); ++i) {
    if (best->chosen[i]) planes_[i] = best_sights[i].candidates[*best->chosen[i]];
  }
  return best;
}

/// The returns that are on the plates as the estimate has them, of the captures that count; of the others
/// what was found without it.
void Calibrator::takePlanes(const RigEstimate& estimate, EdgesToo edges) {
  const LaserGuess& laser = *input_.laser;
  for (std::size_t i = 0; i < data_.captures.size(); ++i) {
    CaptureObservations& capture = data_.captures[i];
    capture.plane = planes_[i];
    capture.edges.clear();
    if (!counts_[i] || !capture.plane) continue;
    const Pose T_laser_board = estimate.T_reference_laser.inverse() * estimate.T_reference_board[i];
    const ReturnSet& returns = result_.captures[i].returns_laser;
    if (laser.kind != LaserKind::beam) {
      const double slack = kSlack + 5.0 * capture.plane->sigma;
      auto moments = planeMoments(returnsOnBoard(returns, T_laser_board, input_.board, kInset, slack),
                                  laser.kind, laser.range_sigma);
      if (moments) capture.plane = *std::move(moments);
    }
    if (edges == EdgesToo::yes)
      capture.edges = edgeSides(returns, laser.kind, T_laser_board, input_.board, capture.plane->sigma);
  }
}

void Calibrator::calibrateLaser() {
  result_.laser.emplace();
  const std::optional<LaserStart> start = findLaser();
  if (!start) return refuseLaser("no capture has the board in the laser's data");
  counts_.assign(planes_.size(), true);
  RigEstimate estimate = result_.estimate;
  takePlanes(estimate, EdgesToo::no);
  if (const auto reason = tooFewCaptures(data_)) return refuseLaser(*reason);
  if (start->rival) return refuseLaser(rivalWords(*start, data_, estimate));
  estimate.T_reference_laser = start->T_reference_laser;
  if (data_.laser == LaserKind::beam)
    estimate.T_reference_laser = withRollOf(input_.laser->T_reference_laser, start->T_reference_laser);
  for (int round = 0; round < kSelectionRounds; ++round) {
    tell("captures that fit", static_cast<double>(round) / kSelectionRounds);
    if (round > 0) takePlanes(estimate, EdgesToo::no);
    const CaptureSelection selection =
        selectCaptures(captureSights(), data_.laser, estimate.T_reference_laser);
    counts_ = selection.counts;
    model_.range_bias_sigma = selection.range_bias_sigma;
    estimate.T_reference_laser = selection.T_reference_laser;
    if (round + 1 == kSelectionRounds) dropCaptures(selection, estimate);
  }
  fitTogether(std::move(estimate));
}

/// Planes and edges of the captures that count, and the bundle, in turn: edges are found where the last
/// estimate has them.
void Calibrator::fitTogether(RigEstimate estimate) {
  for (int round = 0; round < kBundleRounds; ++round) {
    tell("bundle", static_cast<double>(round) / kBundleRounds);
    takePlanes(estimate, EdgesToo::yes);
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      if (!counts_[i]) data_.captures[i].plane.reset();
    }
    BundleFit fit = fitWithNoise(data_, estimate, model_);
    if (dropEdgeOutliers(data_, fit.estimate, model_) > 0) fit = fitWithNoise(data_, fit.estimate, model_);
    estimate = std::move(fit.estimate);
  }
  if (data_.laser == LaserKind::beam)
    estimate.T_reference_laser = withRollOf(input_.laser->T_reference_laser, estimate.T_reference_laser);
  result_.estimate = std::move(estimate);
}

std::vector<CaptureSight> Calibrator::captureSights() const {
  std::vector<CaptureSight> sights;
  for (std::size_t i = 0; i < data_.captures.size(); ++i)
    sights.push_back({result_.estimate.T_reference_board[i], board_covariances_[i], data_.captures[i].plane});
  return sights;
}

void Calibrator::dropCaptures(const CaptureSelection& selection, const RigEstimate& estimate) {
  for (std::size_t i = 0; i < result_.captures.size(); ++i) {
    const BoardCapture& capture = result_.captures[i];
    if (capture.returns_laser.empty()) continue;
    if (data_.captures[i].corners.empty()) {
      result_.dropped.push_back({capture.name, "no image of it shows the whole board"});
    } else if (!planes_[i]) {
      result_.dropped.push_back({capture.name, "its returns have no board where the images have it"});
    } else if (!selection.counts[i]) {
      result_.dropped.push_back(
          {capture.name, movedWords(*planes_[i], estimate, i, selection.probability[i])});
    } else {
      result_.used.push_back(capture.name);
    }
  }
}

void Calibrator::refuseLaser(const std::string& reason) {
  result_.laser->observable = false;
  result_.laser->reason = reason;
  for (CaptureObservations& capture : data_.captures) {
    capture.plane.reset();
    capture.edges.clear();
  }
}

void Calibrator::judgeCameras(const Linearisation& linear, const Eigen::MatrixXd& covariance) {
  for (std::size_t camera = 0; camera < result_.cameras.size(); ++camera) {
    CameraVerdict& verdict = result_.cameras[camera];
    verdict.corner_factor = model_.corner_factor[camera];
    const std::vector<int>& free = model_.free_intrinsics[camera];
    const int first = linear.layout.intrinsics[camera];
    if (first >= 0 && covariance.size() > 0) {
      const int all = kDistortion + result_.estimate.cameras[camera].distortion_count;
      verdict.covariance_intrinsics = Eigen::MatrixXd::Zero(all, all);
      for (std::size_t i = 0; i < free.size(); ++i) {
        for (std::size_t j = 0; j < free.size(); ++j)
          verdict.covariance_intrinsics(free[i], free[j]) =
              covariance(first + static_cast<Eigen::Index>(i), first + static_cast<Eigen::Index>(j));
      }
    }
    const int pose = linear.layout.camera_pose[camera];
    verdict.pose_estimated = pose >= 0 && covariance.size() > 0;
    if (verdict.pose_estimated) verdict.covariance_pose = covariance.block<6, 6>(pose, pose);
  }
}

void Calibrator::judgeLaser(const Linearisation& linear, const Eigen::MatrixXd& covariance) {
  const LaserVerdictInput about{.kind = data_.laser,
                                .free_intrinsics = model_.free_intrinsics.front(),
                                .captures = static_cast<int>(data_.captures.size())};
  if (covariance.size() == 0)
    return refuseLaser(undeterminedWords("the laser's pose", data_, result_.estimate));
  result_.laser = laserVerdict(linear, covariance, result_.estimate, about);
  describe(*result_.laser, data_, result_.estimate, model_.range_bias_sigma);
}

void Calibrator::judge() {
  tell("verdict", 0.0);
  const Linearisation linear = linearise(data_, result_.estimate, model_);
  const JointCovariance joint = jointCovariance(linear);
  judgeCameras(linear, joint.covariance);
  if (result_.laser && result_.laser->reason.empty()) judgeLaser(linear, joint.covariance);
  const ResidualSummary residuals = summarise(data_, result_.estimate);
  for (std::size_t i = 0; i < result_.cameras.size(); ++i) {
    result_.cameras[i].corners = residuals.corners[i];
    result_.cameras[i].rms_px = residuals.rms_px[i];
  }
  result_.rms_mm = residuals.rms_mm;
  result_.range_bias_sigma = model_.range_bias_sigma;
  result_.data = data_;
}

RigCalibration Calibrator::run() {
  startFromCameras();
  fitCameras();
  if (input_.laser) {
    calibrateLaser();
  } else {
    for (std::size_t i = 0; i < data_.captures.size(); ++i) {
      if (!data_.captures[i].corners.empty()) result_.used.push_back(result_.captures[i].name);
    }
  }
  judge();
  return std::move(result_);
}

}  // namespace

RigCalibration calibrateRig(const CalibrationInput& input, const CalibrationOptions& options) {
  return Calibrator(input, options).run();
}

}  // namespace thermovox
