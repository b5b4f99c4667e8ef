#include "apps/calibration_captures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/board_images.hpp"
#include "calibration/board_search.hpp"

namespace thermovox {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kInset = 0.01;      // metres: as the calibration takes returns
constexpr double kOutlier = 3.5;     // sigmas, likewise
constexpr double kNear = 0.1;        // metres off the board, of what is drawn
constexpr double kNearGuess = 0.5;   // the same, where the laser's place is a guess
constexpr std::size_t kDrawn = 600;  // returns in a picture

/// A capture of the folder, and its place in the result: none where the result knows nothing of it.
struct Place {
  const CalibrationRun& run;
  std::size_t file;
  std::optional<std::size_t> result;

  /// Where the board was; none where no image of it counts.
  [[nodiscard]] const Pose* T_reference_board() const {
    if (!result || run.result.data.captures[*result].corners.empty()) return nullptr;
    return &run.result.estimate.T_reference_board[*result];
  }
  [[nodiscard]] const std::string& name() const { return run.folder.captures[file].name; }
};

Place placeOf(const CalibrationRun& run, std::size_t file) {
  const auto& captures = run.result.captures;
  const auto found = std::find_if(captures.begin(), captures.end(), [&](const BoardCapture& capture) {
    return capture.name == run.folder.captures[file].name;
  });
  const auto place = static_cast<std::size_t>(found - captures.begin());
  const bool known = found != captures.end() && place < run.result.data.captures.size() &&
                     place < run.result.estimate.T_reference_board.size();
  return {run, file, known ? std::optional(place) : std::nullopt};
}

std::optional<Eigen::Vector2d> modelledPixel(const Place& place, std::size_t camera, std::size_t point) {
  const Pose* board = place.T_reference_board();
  const RigEstimate& estimate = place.run.result.estimate;
  if (board == nullptr || point >= place.run.result.data.points.size()) return std::nullopt;
  const Eigen::Vector3d p =
      estimate.T_camera_reference[camera] * (*board * place.run.result.data.points[point]);
  if (!(p.z() > 0.0)) return std::nullopt;
  const Intrinsics& lens = estimate.cameras[camera];
  return pixelFromCamera<double>(lens.model, lens.parameters.data(), p);
}

std::vector<ReportedCorner> cornersOf(const Place& place, std::size_t camera) {
  const auto& found = place.run.input.captures[place.file].views[camera];
  if (!found) return {};
  const auto* turned = place.result ? &place.run.result.captures[*place.result].views[camera] : nullptr;
  const bool kept = turned != nullptr && turned->has_value();
  const BoardView& view = kept ? **turned : *found;
  std::vector<ReportedCorner> corners;
  for (std::size_t i = 0; i < view.size(); ++i) {
    corners.push_back({view[i].pixel, std::nullopt, false});
    if (kept) corners.back().modelled = modelledPixel(place, camera, i);
  }
  if (!kept) return corners;
  for (const CornerObservation& seen : place.run.result.data.captures[*place.result].corners) {
    if (seen.camera == static_cast<int>(camera) && static_cast<std::size_t>(seen.point) < corners.size())
      corners[static_cast<std::size_t>(seen.point)].counts = true;
  }
  return corners;
}

GreyImage imageOf(const CalibrationRun& run, const CaptureFiles& files, CalibrationCamera camera) {
  BoardImage image =
      camera == CalibrationCamera::thermal
          ? readThermalBoard(*files.thermal, files.place, run.folder.rig.thermal_camera->camera)
          : readVisibleBoard(*files.visible, files.place, run.folder.rig.visible_camera->camera);
  return {image.width, image.height, std::move(image.values)};
}

std::vector<ReportedView> viewsOf(const Place& place) {
  const CaptureFiles& files = place.run.folder.captures[place.file];
  std::vector<ReportedView> views;
  for (std::size_t camera = 0; camera < place.run.cameras.size(); ++camera) {
    const bool thermal = place.run.cameras[camera] == CalibrationCamera::thermal;
    const auto& file = thermal ? files.thermal : files.visible;
    if (!file) continue;
    ReportedView view{.camera = camera,
                      .file = file->filename().string(),
                      .picture = {},
                      .corners = cornersOf(place, camera),
                      .reason = {}};
    std::vector<Eigen::Vector2d> marks;
    for (const ReportedCorner& corner : view.corners) marks.push_back(corner.found);
    view.picture = calibrationPicture(imageOf(place.run, files, place.run.cameras[camera]), marks);
    const bool any = std::any_of(view.corners.begin(), view.corners.end(),
                                 [](const ReportedCorner& corner) { return corner.counts; });
    if (!view.corners.empty() && !any) view.reason = "This view does not count.";
    views.push_back(std::move(view));
  }
  return views;
}

ReportedBoard boardOf(const Pose& T_reference_board) {
  const Eigen::Vector3d n = T_reference_board.rotation * Eigen::Vector3d::UnitZ();
  return {T_reference_board.translation.norm(), std::atan2(-n.y(), n.z()) / kDegree,
          std::atan2(n.x(), n.z()) / kDegree};
}

/// A return whose ray meets the board: how far behind its plane it lies, and whether it counts, metres.
struct OnBoard {
  Eigen::Vector3d p_laser;
  double residual = 0.0;
  bool counts = true;
};

std::vector<OnBoard> returnsOnBoard(const Place& place, const Pose& T_reference_laser) {
  const CalibrationRun& run = place.run;
  const Pose T_board_laser = place.T_reference_board()->inverse() * T_reference_laser;
  const auto& plane = run.result.data.captures[*place.result].plane;
  const double slack = laserByGuess(run) ? kNearGuess : kNear + (plane ? 5.0 * plane->sigma : 0.0);
  std::vector<OnBoard> on_board;
  for (const Eigen::Vector3d& p :
       thermovox::returnsOnBoard(run.result.captures[*place.result].returns_laser, T_board_laser.inverse(),
                                 run.input.board, kInset, slack)) {
    const double range = p.norm();
    const double modelled = -T_board_laser.translation.z() / (T_board_laser.rotation * (p / range)).z();
    on_board.push_back({p, range - modelled, true});
    if (plane) {
      const double own = range - range / plane->inverse_plane.dot(p);
      on_board.back().counts = std::abs(own) <= kOutlier * plane->sigma;
    }
  }
  return on_board;
}

ReportedRanges rangesOf(const Place& place, const std::vector<OnBoard>& on_board) {
  ReportedRanges ranges;
  double sum = 0.0, squares = 0.0;
  for (const OnBoard& echo : on_board) {
    if (!echo.counts) continue;
    ++ranges.returns;
    sum += echo.residual;
    squares += echo.residual * echo.residual;
  }
  ranges.left_out = on_board.size() - ranges.returns;
  const double count = std::max(1.0, static_cast<double>(ranges.returns));
  ranges.offset_mm = 1e3 * sum / count;
  ranges.scatter_mm = 1e3 * std::sqrt(std::max(0.0, squares / count - std::pow(sum / count, 2)));
  const auto& plane = place.run.result.data.captures[*place.result].plane;
  if (!plane) return ranges;
  ranges.scatter_mm = 1e3 * plane->sigma;
  const auto& biases = place.run.result.estimate.range_bias;
  if (*place.result < biases.size())
    ranges.bias_mm = -1e3 * (biases[*place.result] + place.run.result.estimate.common_range_bias);
  return ranges;
}

void addReturns(ReportedCapture& capture, const Place& place) {
  const CalibrationRun& run = place.run;
  if (!run.input.laser || place.T_reference_board() == nullptr) return;
  const Pose& T_reference_laser =
      laserByGuess(run) ? run.input.laser->T_reference_laser : run.result.estimate.T_reference_laser;
  const std::vector<OnBoard> on_board = returnsOnBoard(place, T_reference_laser);
  if (run.result.captures[*place.result].returns_laser.empty()) return;
  capture.ranges = rangesOf(place, on_board);
  const Camera camera(run.result.estimate.cameras.front());
  const bool beam = run.input.laser->kind == LaserKind::beam;  // all of it is one place: its mean is drawn
  const std::size_t every = beam ? 1 : on_board.size() / kDrawn + 1;
  for (std::size_t i = 0; i < on_board.size(); i += every) {
    const auto pixel = camera.project(T_reference_laser * on_board[i].p_laser);
    if (!pixel || (beam && !on_board[i].counts)) continue;
    const double residual_mm = beam ? capture.ranges->offset_mm : 1e3 * on_board[i].residual;
    capture.returns.push_back({*pixel, residual_mm, on_board[i].counts});
    if (beam) break;
  }
}

/// Whether a capture counts, and why not, or what of it does not.
void judge(ReportedCapture& capture, const Place& place) {
  const RigCalibration& result = place.run.result;
  capture.counts = std::find(result.used.begin(), result.used.end(), capture.name) != result.used.end();
  for (const DroppedCapture& dropped : result.dropped) {
    if (dropped.capture != capture.name) continue;
    capture.reason += (capture.reason.empty() ? "" : "; ") + dropped.reason;
  }
  const bool seen = place.T_reference_board() != nullptr;
  const bool laser = place.run.folder.captures[place.file].laser.has_value();
  if (capture.counts || !place.run.input.laser) {
    if (!capture.counts && capture.reason.empty()) capture.reason = "no image of it shows the whole board";
    return;
  }
  if (!laser && seen) {
    capture.counts = true;
    capture.reason = "for the cameras: it has no returns of the laser";
  } else if (seen) {
    if (capture.reason.empty()) capture.reason = "the laser's pose was not found";
    capture.reason += "; its images still count";
  } else if (capture.reason.empty()) {
    capture.reason = "no image of it shows the whole board";
  }
}

}  // namespace

bool laserByGuess(const CalibrationRun& run) {
  return run.input.laser && std::none_of(run.result.data.captures.begin(), run.result.data.captures.end(),
                                         [](const auto& capture) { return capture.plane.has_value(); });
}

std::vector<ReportedCapture> reportedCaptures(const CalibrationRun& run) {
  std::vector<ReportedCapture> captures;
  for (std::size_t i = 0; i < run.folder.captures.size(); ++i) {
    const Place place = placeOf(run, i);
    ReportedCapture capture;
    capture.name = place.name();
    capture.views = viewsOf(place);
    if (const Pose* board = place.T_reference_board()) capture.board = boardOf(*board);
    addReturns(capture, place);
    judge(capture, place);
    captures.push_back(std::move(capture));
  }
  return captures;
}

}  // namespace thermovox
