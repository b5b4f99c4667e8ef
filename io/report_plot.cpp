#include "io/report_plot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/picture_canvas.hpp"
#include "io/report_html.hpp"

namespace thermovox {
namespace {

constexpr double kWidth = 700.0, kHeight = 210.0;
constexpr double kLeft = 46.0, kRight = 690.0, kTop = 14.0, kBottom = 172.0;
constexpr double k95 = 1.96;  ///< sigmas on either side that hold 95 %

/// Where things lie in the plot.
struct Axes {
  TemperatureSpan span;  ///< Celsius, from bottom to top
  double step = 0.0;     ///< px from mission to mission

  [[nodiscard]] double x(std::size_t i) const { return kLeft + step * (static_cast<double>(i) + 0.5); }
  [[nodiscard]] double y(double celsius) const {
    return kBottom - (celsius - span.low) / (span.high - span.low) * (kBottom - kTop);
  }
};

Axes axesOf(std::span<const TrendPoint> points) {
  Axes axes{{0.0, 1.0}, (kRight - kLeft) / static_cast<double>(std::max<std::size_t>(points.size(), 1))};
  for (const TrendPoint& point : points) {
    if (!point.delta) continue;
    axes.span.low = std::min(axes.span.low, point.delta->value - k95 * point.delta->sigma);
    axes.span.high = std::max(axes.span.high, point.delta->value + k95 * point.delta->sigma);
  }
  const double margin = 0.12 * (axes.span.high - axes.span.low);
  axes.span.high += margin;
  if (axes.span.low < 0.0) axes.span.low -= margin;
  return axes;
}

std::string gridOf(const Axes& axes) {
  std::string grid;
  for (const double tick : roundTicks(axes.span, 5)) {
    grid += fmt::format(
        "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"{3}\"/>"
        "<text x=\"{4}\" y=\"{5:.1f}\" text-anchor=\"end\">{6:g}</text>\n",
        kLeft, kRight, axes.y(tick), tick == 0.0 ? "#16191d" : "#dde1e6", kLeft - 6.0, axes.y(tick) + 4.0,
        tick);
  }
  return grid + fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"11\">&deg;C</text>\n", 4, kTop + 4.0);
}

std::string pointDrawing(const TrendPoint& point, double x, const Axes& axes) {
  const double y = axes.y(point.delta->value);
  const double low = axes.y(point.delta->value - k95 * point.delta->sigma);
  const double high = axes.y(point.delta->value + k95 * point.delta->sigma);
  return fmt::format(
      "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h8M{3:.1f} {2:.1f}h8\" stroke=\"#16191d\" "
      "fill=\"none\"/>"
      "<circle cx=\"{0:.1f}\" cy=\"{4:.1f}\" r=\"4.5\" fill=\"{5}\" stroke=\"#a3120a\" stroke-width=\"2\"/>"
      "<text x=\"{6:.1f}\" y=\"{7:.1f}\" font-weight=\"bold\">{8:.1f}</text>\n",
      x, low, high, x - 4.0, y, point.hot ? "#a3120a" : "#fff", x + 8.0, y - 5.0, point.delta->value);
}

std::string gapDrawing(double x, double step) {
  return fmt::format(
      "<rect x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#eef0f2\"/>"
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" fill=\"#4a5058\">not observed</text>\n",
      x - 0.5 * step, kTop, step, kBottom - kTop, x, 0.5 * (kTop + kBottom));
}

}  // namespace

std::string trendPlot(std::span<const TrendPoint> points, const std::string& label) {
  const Axes axes = axesOf(points);
  std::string gaps, line, marks, labels;
  const std::size_t every = points.size() / 12 + 1;  // labels that fit
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % every == 0) {
      labels += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", axes.x(i),
                            kBottom + 20.0, escaped(points[i].label));
    }
    if (!points[i].delta) {
      gaps += gapDrawing(axes.x(i), axes.step);
      continue;
    }
    marks += pointDrawing(points[i], axes.x(i), axes);
    if (i > 0 && points[i - 1].delta) {
      line += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", axes.x(i - 1), axes.y(points[i - 1].delta->value),
                          axes.x(i), axes.y(points[i].delta->value));
    }
  }
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" "
             "font-family=\"Liberation Sans, Arial, sans-serif\" font-size=\"12\">\n",
             kWidth, kHeight, escaped(label)) +
         gaps + gridOf(axes) +
         fmt::format("<path d=\"{}\" stroke=\"#a3120a\" stroke-width=\"1.6\" fill=\"none\"/>\n", line) +
         marks + labels +
         fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\" fill=\"#4a5058\">mission</text>\n",
                     0.5 * (kLeft + kRight), kBottom + 36.0) +
         "</svg>\n";
}

}  // namespace thermovox
