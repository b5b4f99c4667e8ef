#include "calibration/camera_start.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>

#include "calibration/board_points.hpp"
#include "calibration/free_intrinsics.hpp"
#include "calibration/view_pose.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTurnApart = 6.0 * kDegree;  // two captures that agree on how two cameras stand
constexpr double kShiftApart = 0.10;          // metres, likewise
constexpr double kLeastSigma = 0.02;          // px, of a corner: what no covariance knows

/// The captures' views of one camera as a bundle of its own, and which captures they are of.
struct SingleCamera {
  BundleData data;
  RigEstimate estimate;
  std::vector<std::size_t> captures;
};

std::optional<SingleCamera> singleCamera(const CalibrationInput& input, std::size_t camera,
                                         const Intrinsics& intrinsics) {
  const std::vector<Eigen::Vector3d> points = boardPoints(input.board);
  SingleCamera single;
  single.data.points = points;
  single.estimate.cameras = {intrinsics};
  single.estimate.T_camera_reference.resize(1);
  const Camera lens(intrinsics);
  for (std::size_t i = 0; i < input.captures.size(); ++i) {
    const auto& view = input.captures[i].views[camera];
    if (!view) continue;
    const std::optional<Pose> pose = poseFromView(points, *view, lens);
    if (!pose) continue;
    single.estimate.T_reference_board.push_back(*pose);
    single.data.captures.push_back({cornersOf(*view, 0), std::nullopt, {}});
    single.captures.push_back(i);
  }
  if (single.captures.empty()) return std::nullopt;
  return single;
}

/// The numbers of the input, and those of Zhang's closed form without distortion.
std::vector<Intrinsics> lensStarts(const CalibrationInput& input, std::size_t camera) {
  const Intrinsics& guess = input.cameras[camera].intrinsics;
  std::vector<Intrinsics> starts{guess};
  if (input.cameras[camera].lens == CameraGuess::Lens::keep || guess.model == LensModel::kannala_brandt)
    return starts;
  const std::vector<Eigen::Vector3d> points = boardPoints(input.board);
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> views;
  for (const BoardCapture& capture : input.captures) {
    if (!capture.views[camera]) continue;
    boards.emplace_back();
    views.emplace_back();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d& pixel = (*capture.views[camera])[i].pixel;
      boards.back().emplace_back(static_cast<float>(points[i].x()), static_cast<float>(points[i].y()), 0.0F);
      views.back().emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    }
  }
  if (boards.size() < 3) return starts;
  const cv::Mat K = cv::initCameraMatrix2D(boards, views, {guess.width_px, guess.height_px}, 0.0);
  Intrinsics zhang = guess;
  zhang.parameters = {K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2), K.at<double>(1, 2)};
  const double focal = std::min(zhang.parameters[kFx], zhang.parameters[kFy]);
  if (std::isfinite(focal) && focal > 0.1 * guess.width_px && focal < 100.0 * guess.width_px)
    starts.push_back(zhang);
  return starts;
}

struct FittedCamera {
  Intrinsics intrinsics;
  std::vector<std::optional<Pose>> T_camera_board;  ///< of each capture
};

std::optional<FittedCamera> fitCamera(const CalibrationInput& input, std::size_t camera) {
  std::optional<FittedCamera> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Intrinsics& start : lensStarts(input, camera)) {
    std::optional<SingleCamera> single = singleCamera(input, camera, start);
    if (!single) continue;
    const std::size_t views = single->captures.size();
    const BundleModel model{.free_intrinsics = {freeIntrinsics(input.cameras[camera], views)},
                            .corner_factor = {1.0},
                            .corner_loss = BundleModel::Loss::huber};
    const BundleFit fit = solveBundle(single->data, single->estimate, model);
    const double cost = fit.cost / static_cast<double>(views);
    if (!(cost < least) && best) continue;
    least = cost;
    best.emplace();
    best->intrinsics = fit.estimate.cameras.front();
    best->T_camera_board.resize(input.captures.size());
    for (std::size_t i = 0; i < views; ++i)
      best->T_camera_board[single->captures[i]] = fit.estimate.T_reference_board[i];
  }
  return best;
}

double turnBetween(const Pose& a, const Pose& b) {
  return a.rotation.angularDistance(b.rotation);
}

/// How far two answers are from each other, in units of what still agrees.
double apart(const Pose& a, const Pose& b) {
  return std::max(turnBetween(a, b) / kTurnApart, (a.translation - b.translation).norm() / kShiftApart);
}

/// How the board lies when point i of it is where `symmetry`[i] was.
Pose symmetryPose(const std::vector<Eigen::Vector3d>& points, const std::vector<std::size_t>& symmetry) {
  const Eigen::Vector3d& from = points.front();
  const Eigen::Vector3d& to = points[symmetry.front()];
  const double turn = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  return {expRotation({0.0, 0.0, turn}), Eigen::Vector3d::Zero()};
}

/// One answer for T_camera_reference: of a capture, with the board of the camera's view turned.
struct Answer {
  std::size_t capture;
  std::size_t symmetry;
  Pose T_camera_reference;
};

std::vector<Answer> answersOf(const CalibrationInput& input, const FittedCamera& reference,
                              const FittedCamera& camera) {
  const std::vector<Eigen::Vector3d> points = boardPoints(input.board);
  const auto symmetries = boardSymmetries(input.board);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < input.captures.size(); ++i) {
    if (!reference.T_camera_board[i] || !camera.T_camera_board[i]) continue;
    for (std::size_t k = 0; k < symmetries.size(); ++k) {
      const Pose turned = *camera.T_camera_board[i] * symmetryPose(points, symmetries[k]);
      answers.push_back({i, k, turned * reference.T_camera_board[i]->inverse()});
    }
  }
  return answers;
}

/// The answer that most captures share; of equals the one nearer to `guess`.
const Answer* consensus(const std::vector<Answer>& answers, const Pose& guess) {
  const Answer* best = nullptr;
  double best_score = -1.0;
  for (const Answer& candidate : answers) {
    double score = 0.0;
    std::size_t last = std::numeric_limits<std::size_t>::max();
    double nearest = 1.0;  // of the capture at hand
    for (const Answer& other : answers) {
      if (other.capture != last) {
        score += 1.0 - nearest;
        last = other.capture;
        nearest = 1.0;
      }
      nearest = std::min(nearest, apart(candidate.T_camera_reference, other.T_camera_reference));
    }
    score += 1.0 - nearest;
    score -= 1e-3 * turnBetween(candidate.T_camera_reference, guess);
    if (score > best_score || best == nullptr) {
      best_score = score;
      best = &candidate;
    }
  }
  return best;
}

/// Puts the corners of a view into the order they have on the board turned by a symmetry.
BoardView reordered(const BoardView& view, const std::vector<std::size_t>& symmetry) {
  BoardView turned(view.size());
  for (std::size_t i = 0; i < view.size(); ++i) turned[i] = view[symmetry[i]];
  return turned;
}

/// Turns the views of a camera to the board of the reference camera, and leaves out those that do not fit.
void align(CameraStart& start, const CalibrationInput& input, std::size_t camera,
           const std::vector<Answer>& answers, const Pose& T_camera_reference) {
  const auto symmetries = boardSymmetries(input.board);
  for (std::size_t i = 0; i < start.captures.size(); ++i) {
    const Answer* nearest = nullptr;
    for (const Answer& answer : answers) {
      if (answer.capture != i) continue;
      if (nearest == nullptr || apart(answer.T_camera_reference, T_camera_reference) <
                                    apart(nearest->T_camera_reference, T_camera_reference))
        nearest = &answer;
    }
    if (nearest == nullptr) continue;
    std::optional<BoardView>& view = start.captures[i].views[camera];
    if (apart(nearest->T_camera_reference, T_camera_reference) > 1.0) {
      view.reset();
      start.dropped.push_back(
          {start.captures[i].name, "the board moved between the images of the two cameras"});
    } else {
      view = reordered(*view, symmetries[nearest->symmetry]);
    }
  }
}

}  // namespace

std::vector<CornerObservation> cornersOf(const BoardView& view, int camera) {
  std::vector<CornerObservation> corners;
  for (std::size_t i = 0; i < view.size(); ++i) {
    corners.push_back({camera, static_cast<int>(i), view[i].pixel,
                       view[i].covariance + kLeastSigma * kLeastSigma * Eigen::Matrix2d::Identity()});
  }
  return corners;
}

CameraStart startCameras(const CalibrationInput& input) {
  CameraStart start{.estimate = {}, .captures = input.captures, .dropped = {}};
  std::vector<std::optional<FittedCamera>> fitted;
  for (std::size_t camera = 0; camera < input.cameras.size(); ++camera) {
    fitted.push_back(fitCamera(input, camera));
    start.estimate.cameras.push_back(fitted.back() ? fitted.back()->intrinsics
                                                   : input.cameras[camera].intrinsics);
    start.estimate.T_camera_reference.push_back(input.cameras[camera].T_reference_camera.inverse());
  }
  if (!fitted.front()) {
    throw UnobservableError("no capture shows the whole board to the camera, expected three or more");
  }
  start.estimate.T_camera_reference.front() = {};
  for (std::size_t camera = 1; camera < input.cameras.size(); ++camera) {
    if (!fitted[camera]) continue;
    const std::vector<Answer> answers = answersOf(input, *fitted.front(), *fitted[camera]);
    if (const Answer* best = consensus(answers, start.estimate.T_camera_reference[camera])) {
      start.estimate.T_camera_reference[camera] = best->T_camera_reference;
      align(start, input, camera, answers, best->T_camera_reference);
    }
  }
  for (std::size_t i = 0; i < input.captures.size(); ++i) {
    std::optional<Pose> pose = fitted.front()->T_camera_board[i];
    for (std::size_t camera = 1; camera < fitted.size() && !pose; ++camera) {
      if (fitted[camera] && fitted[camera]->T_camera_board[i])
        pose = start.estimate.T_camera_reference[camera].inverse() * *fitted[camera]->T_camera_board[i];
    }
    start.estimate.T_reference_board.push_back(pose.value_or(Pose{}));
    start.estimate.range_bias.push_back(0.0);
  }
  return start;
}

}  // namespace thermovox
