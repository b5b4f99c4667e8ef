#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/calibration_picture.hpp"
#include "projection/pose.hpp"

namespace thermovox {

// What a report of a calibration tells, in plain numbers: who calibrates fills it in.

/// A corner of the board in an image, px.
struct ReportedCorner {
  Eigen::Vector2d found = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> modelled;  ///< where the calibration has it; none where it does not know
  bool counts = true;                       ///< false: left out, too far off or of a view that does not count
};

/// A return of the laser whose ray meets the board.
struct ReportedReturn {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< in the reference camera's image
  double residual_mm = 0.0;                         ///< along the ray; positive: behind the board's plane
  bool counts = true;
};

/// A camera's image in a capture.
struct ReportedView {
  std::size_t camera = 0;  ///< of CalibrationReport::cameras
  std::string file;
  std::optional<CalibrationPicture> picture;
  std::vector<ReportedCorner> corners;  ///< row by row; empty: no board was found
  std::string reason;                   ///< why it does not count; empty where it does
};

/// How the board was held, in the reference camera's frame.
struct ReportedBoard {
  double distance = 0.0;                      ///< metres
  double tilt_x_deg = 0.0, tilt_y_deg = 0.0;  ///< about the camera's x (right) and y (down)
};

/// What the laser measured of the board.
struct ReportedRanges {
  std::size_t returns = 0, left_out = 0;
  double offset_mm = 0.0;         ///< mean of the residuals
  std::optional<double> bias_mm;  ///< what of it the calibration takes for an error of all its ranges
  double scatter_mm = 0.0;        ///< one sigma of a range about the returns' own plane
};

struct ReportedCapture {
  std::string name;
  bool counts = true;
  std::string reason;  ///< why it does not count, or only in part
  std::vector<ReportedView> views;
  std::optional<ReportedBoard> board;
  std::vector<ReportedReturn> returns;  ///< some of them, to be drawn
  std::optional<ReportedRanges> ranges;
};

/// A number that was estimated, or kept.
struct ReportedNumber {
  std::string name, unit;
  double value = 0.0;
  std::optional<double> sigma;  ///< none: it was kept
  double guess = 0.0;           ///< what it was before
};

struct ReportedCamera {
  std::string name;  ///< "thermal camera"
  int width_px = 0, height_px = 0;
  int corners = 0, left_out = 0;
  double rms_px = 0.0;         ///< per axis
  double corner_factor = 1.0;  ///< what the corners' own sigmas had to be multiplied by
  std::vector<ReportedNumber> intrinsics;
  Eigen::MatrixXd covariance;  ///< of these; empty: they were kept
};

/// A mounting that was estimated.
struct ReportedPose {
  std::string name;  ///< "T_body_laser"
  std::string note;
  Pose pose, guess;
  Matrix6d covariance = Matrix6d::Zero();  ///< (rotation, translation) along the body's axes: rad, m
};

/// How far beside its pixel a point comes to lie, one sigma.
struct ReportedTransfer {
  double distance = 0.0;  ///< metres
  double sigma_px = 0.0;
};

struct CalibrationReport {
  std::string title;    ///< of the captures
  std::string task;     ///< "the laser's pose": what was to be determined
  std::string version;  ///< of the program
  bool determined = true;
  std::string reason;                 ///< why not
  std::vector<std::string> findings;  ///< sentences below the verdict
  std::vector<std::string> warnings;
  std::string board;                    ///< the board in words
  int columns = 0;                      ///< corners in a row of it
  std::vector<ReportedCamera> cameras;  ///< the reference camera first
  std::vector<ReportedPose> poses;
  std::vector<ReportedTransfer> transfer;
  std::vector<std::pair<std::string, std::string>> laser;  ///< facts about it: what, how much; may be empty
  bool by_first_guess = false;  ///< the laser's returns stand where the rig's first guess puts them
  std::vector<ReportedCapture> captures;
};

/// One HTML file that needs nothing beside it: verdict, cameras with residuals and coverage, mountings with
/// covariances, how the board was held, and every capture with what was found in it. The same report gives
/// the same bytes. Numbers that are not finite are dashes.
[[nodiscard]] std::string calibrationReportHtml(const CalibrationReport& report);

/// Writes it, whole or not at all. Throws DataError naming the file.
void writeCalibrationHtml(const std::filesystem::path& file, const CalibrationReport& report,
                          Existing existing);

}  // namespace thermovox
