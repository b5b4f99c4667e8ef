#pragma once

#include <string>

#include "io/calibration_report.hpp"

namespace thermovox {

// Drawings of a calibration's report, as SVG.

/// How many times too long residuals are drawn: a round number.
struct QuiverScale {
  double times = 1.0;
};

/// The scale of a camera's residuals so that most stay apart: over `extent` px at the 95th percentile.
[[nodiscard]] QuiverScale quiverScale(const CalibrationReport& report, std::size_t camera, double extent_px);

/// Median distance of neighbours in a row of the board, px; 0 where no board was found.
[[nodiscard]] double cornerSpacing(const CalibrationReport& report, std::size_t camera);

/// A camera's image with all corners that count, their residuals, and the mean residual of each cell.
[[nodiscard]] std::string residualMap(const CalibrationReport& report, std::size_t camera,
                                      const QuiverScale& scale);

/// Cells of a camera's image by how many corners lay there.
struct Coverage {
  int columns = 8, rows = 6;
  std::vector<int> corners;  ///< row by row
  [[nodiscard]] int covered() const;
};
[[nodiscard]] Coverage coverageOf(const CalibrationReport& report, std::size_t camera);
[[nodiscard]] std::string coverageMap(const CalibrationReport& report, std::size_t camera);

/// How often residuals (u and v alike) were how large, against a Gaussian of the same width.
[[nodiscard]] std::string residualHistogram(const CalibrationReport& report, std::size_t camera);

/// The rms of each capture's residuals, with its number.
[[nodiscard]] std::string captureBars(const CalibrationReport& report, std::size_t camera);

/// What is left of a view's corners: how many count, and how far they are off (not finite where unknown).
struct ViewNumbers {
  std::size_t counted = 0, left_out = 0;
  double rms_px = 0.0;
};
[[nodiscard]] ViewNumbers numbersOf(const ReportedView& view);

/// The boards' tilts about the camera's axes, coloured by distance.
[[nodiscard]] std::string tiltPlot(const CalibrationReport& report);

/// A view with what was found in it and what the calibration makes of it.
[[nodiscard]] std::string viewDrawing(const ReportedView& view, int columns, const QuiverScale& scale,
                                      const std::string& id);

/// The laser's returns over the picture that viewDrawing() has given the id; colours to +-limit_mm.
[[nodiscard]] std::string returnsDrawing(const ReportedView& view, const ReportedCapture& capture,
                                         double limit_mm, const std::string& id);

/// The colours of the returns as a bar with a scale.
[[nodiscard]] std::string residualBar(double limit_mm);

/// What the ends of the colours stand for: a round number that most returns are within, mm.
[[nodiscard]] double residualLimit(const CalibrationReport& report);

}  // namespace thermovox
