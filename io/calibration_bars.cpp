#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/calibration_plots.hpp"
#include "io/picture_canvas.hpp"
#include "io/svg_text.hpp"

namespace thermovox {
namespace {

/// A capture's number and how far its corners are off, px rms.
struct Bar {
  std::size_t number = 0;
  double rms_px = 0.0;
};

std::vector<Bar> barsOf(const CalibrationReport& report, std::size_t camera) {
  std::vector<Bar> bars;
  for (std::size_t i = 0; i < report.captures.size(); ++i) {
    for (const ReportedView& view : report.captures[i].views) {
      const double rms = numbersOf(view).rms_px;
      if (view.camera == camera && std::isfinite(rms)) bars.push_back({i + 1, rms});
    }
  }
  return bars;
}

}  // namespace

ViewNumbers numbersOf(const ReportedView& view) {
  ViewNumbers numbers;
  double squares = 0.0;
  for (const ReportedCorner& corner : view.corners) {
    ++(corner.counts ? numbers.counted : numbers.left_out);
    if (corner.counts)
      squares += corner.modelled ? (corner.found - *corner.modelled).squaredNorm() : std::nan("");
  }
  numbers.rms_px = std::sqrt(squares / static_cast<double>(numbers.counted));  // of none: not a number
  return numbers;
}

std::string captureBars(const CalibrationReport& report, std::size_t camera) {
  constexpr double kLeft = 34.0, kRight = 340.0, kFoot = 120.0, kHigh = 106.0;
  const std::vector<Bar> bars = barsOf(report, camera);
  double most = 0.0;
  for (const Bar& bar : bars) most = std::max(most, bar.rms_px);
  if (!(most > 0.0)) return {};
  std::string content;
  for (const double tick : roundTicks({0.0, most}, 4)) {
    const double y = kFoot - kHigh * tick / most;
    content += fmt::format(
        "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#dde1e6\"/><text x=\"{3}\" "
        "y=\"{4:.1f}\" "
        "font-size=\"10\" text-anchor=\"end\">{5:g}</text>\n",
        kLeft, kRight, y, kLeft - 4.0, y + 3.5, tick);
  }
  const double step = (kRight - kLeft) / static_cast<double>(bars.size());
  const std::size_t every = bars.size() / 20 + 1;  // numbers that fit
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double x = kLeft + step * static_cast<double>(i), height = kHigh * bars[i].rms_px / most;
    content +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#5b7fa6\"/>",
                    x + 0.12 * step, kFoot - height, 0.76 * step, height);
    if (i % every == 0)
      content +=
          fmt::format("<text x=\"{:.1f}\" y=\"{}\" font-size=\"10\" text-anchor=\"middle\">{}</text>\n",
                      x + 0.5 * step, kFoot + 13.0, bars[i].number);
  }
  return svgOf({Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(kRight, 140.0)}, "residuals of each capture",
               content);
}

}  // namespace thermovox
