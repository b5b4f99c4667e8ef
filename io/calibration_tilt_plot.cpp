#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/calibration_plots.hpp"
#include "io/svg_text.hpp"

namespace thermovox {
namespace {

constexpr double kMost = 75.0;                                 ///< degrees at the plot's ends
constexpr double kMiddle = 160.0, kPerDegree = 130.0 / kMost;  ///< px

double placeOf(double degrees) {
  return kMiddle + kPerDegree * std::clamp(degrees, -kMost, kMost);
}

/// Rings at 30 and 60 degrees, between which boards should be, and the axes.
std::string axesDrawing() {
  std::string drawing = fmt::format(
      "<path d=\"M{1:.1f} {0:.1f}H{2:.1f}M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#9aa3ad\" fill=\"none\"/>\n",
      placeOf(0.0), placeOf(-kMost), placeOf(kMost));
  for (const double ring : {30.0, 60.0}) {
    drawing += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{0:.1f}\" r=\"{1:.1f}\" fill=\"none\" stroke=\"#9aa3ad\" "
        "stroke-dasharray=\"3 3\"/>"
        "<text x=\"{2:.1f}\" y=\"{3:.1f}\" font-size=\"10\" fill=\"#4a5058\">{4:g}&deg;</text>\n",
        kMiddle, kPerDegree * ring, placeOf(0.7071 * ring) + 2.0, placeOf(0.7071 * ring) + 10.0, ring);
  }
  return drawing + fmt::format(
                       "<text x=\"{0:.1f}\" y=\"312\" font-size=\"11\" text-anchor=\"middle\">faces left "
                       "&larr; tilt about the camera's y &rarr; faces right</text>"
                       "<text transform=\"translate(12 {0:.1f}) rotate(-90)\" font-size=\"11\" "
                       "text-anchor=\"middle\">faces down &larr; tilt about its x &rarr; faces up</text>\n",
                       kMiddle);
}

std::string distanceScale(double nearest, double farthest) {
  constexpr int kSteps = 40;
  constexpr double kHigh = 260.0, kTop = 30.0;
  std::string drawing;
  for (int i = 0; i < kSteps; ++i) {
    drawing += fmt::format("<rect x=\"330\" y=\"{:.1f}\" width=\"12\" height=\"{:.1f}\" fill=\"{}\"/>",
                           kTop + kHigh - kHigh * (i + 1) / kSteps, kHigh / kSteps + 0.3,
                           hexOf(colourAt(Palette::viridis, (i + 0.5) / kSteps)));
  }
  for (int i = 0; i <= 4; ++i) {
    drawing += fmt::format("<text x=\"347\" y=\"{:.1f}\" font-size=\"11\">{} m</text>",
                           kTop + kHigh - kHigh * i / 4.0 + 4.0,
                           numberText(nearest + (farthest - nearest) * i / 4.0, 2));
  }
  return drawing + "<text x=\"330\" y=\"18\" font-size=\"11\">distance</text>\n";
}

}  // namespace

std::string tiltPlot(const CalibrationReport& report) {
  double nearest = 1e9, farthest = 0.0;
  for (const ReportedCapture& capture : report.captures) {
    if (!capture.board || !std::isfinite(capture.board->distance)) continue;
    nearest = std::min(nearest, capture.board->distance);
    farthest = std::max(farthest, capture.board->distance);
  }
  if (nearest > farthest) return {};
  std::string marks;
  for (std::size_t i = 0; i < report.captures.size(); ++i) {
    const auto& board = report.captures[i].board;
    if (!board || !std::isfinite(board->distance + board->tilt_x_deg + board->tilt_y_deg)) continue;
    const double share = farthest > nearest ? (board->distance - nearest) / (farthest - nearest) : 0.5;
    const double x = placeOf(-board->tilt_y_deg), y = placeOf(board->tilt_x_deg);
    const bool counts = report.captures[i].counts;
    const std::string colour = hexOf(colourAt(Palette::viridis, share));
    marks += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{}\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"9\">{}</text>\n",
        x, y, counts ? colour : "#fff", counts ? "#16191d" : colour, counts ? 0.6 : 2.0, x + 6.5, y + 3.0,
        i + 1);
  }
  return svgOf({Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(400.0, 320.0)},
               "tilts and distances of the boards", axesDrawing() + distanceScale(nearest, farthest) + marks);
}

}  // namespace thermovox
