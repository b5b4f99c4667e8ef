#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/calibration_plots.hpp"
#include "io/report_html.hpp"
#include "io/svg_text.hpp"

namespace thermovox {
namespace {

constexpr double kDrawn = 350.0;       ///< css px that a picture is wide: lines are as thin everywhere
constexpr double kPixelsSeen = 240.0;  ///< px up to which single pixels are shown as such

using Points = std::vector<Eigen::Vector2d>;

/// px of the image to a css px.
double unitOf(const CalibrationPicture& picture) {
  return picture.window.sizes().x() / kDrawn;
}

std::string pathOf(const Points& points) {
  std::string path;
  for (const Eigen::Vector2d& p : points) {
    if (!p.allFinite()) continue;
    path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", p.x(), p.y());
  }
  return path;
}

std::string stroke(const std::string& path, const char* colour, double width, const char* more = "") {
  if (path.empty()) return {};
  return fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"{:.3f}\" fill=\"none\"{}/>\n", path, colour,
                     width, more);
}

/// A small frame in the corner: which part of the image is shown.
std::string partDrawing(const CalibrationPicture& picture, double unit) {
  const Eigen::Vector2d image(picture.image_width_px, picture.image_height_px);
  if (picture.window.sizes().x() > image.x() - 0.5) return {};
  constexpr double kWide = 46.0;  // css px
  const double scale = kWide * unit / image.x();
  const Eigen::Vector2d corner = picture.window.min() + Eigen::Vector2d(5.0, 5.0) * unit;
  const Eigen::Vector2d part = corner + scale * (picture.window.min().array() + 0.5).matrix();
  const auto frame = [&](const Eigen::Vector2d& at, const Eigen::Vector2d& size, const char* fill) {
    return fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" stroke=\"#fff\" "
        "stroke-width=\"{:.3f}\"/>",
        at.x(), at.y(), size.x(), size.y(), fill, unit);
  };
  return frame(corner, scale * image, "rgba(0,0,0,0.55)") +
         frame(part, scale * picture.window.sizes(), "#8a929b") + "\n";
}

/// The grid as the calibration has it: along the rows, and across them.
std::string gridDrawing(const ReportedView& view, std::size_t columns, double unit) {
  std::string path;
  const std::size_t rows = columns == 0 ? 0 : view.corners.size() / columns;
  const auto line = [&](std::size_t first, std::size_t step, std::size_t count) {
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
      if (const auto& modelled = view.corners[first + i * step].modelled) points.push_back(*modelled);
    }
    path += pathOf(points);
  };
  for (std::size_t row = 0; row < rows; ++row) line(row * columns, 1, columns);
  for (std::size_t column = 0; rows > 0 && column < columns; ++column) line(column, columns, rows);
  return stroke(path, "#19b5fe", 0.8 * unit);
}

/// The order of the corners: the first row is marked, with a ring about the first corner.
std::string orderDrawing(const ReportedView& view, std::size_t columns, double unit) {
  if (view.corners.empty()) return {};
  Points first;
  for (std::size_t i = 0; i < std::min(columns, view.corners.size()); ++i)
    first.push_back(view.corners[i].found);
  std::string drawing = stroke(pathOf(first), "#ffb000", 1.8 * unit);
  const Eigen::Vector2d& start = view.corners.front().found;
  if (!start.allFinite()) return drawing;
  return drawing + fmt::format(
                       "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" fill=\"none\" stroke=\"#ffb000\" "
                       "stroke-width=\"{:.3f}\"/>\n",
                       start.x(), start.y(), 6.0 * unit, 1.8 * unit);
}

std::string cornerDrawing(const ReportedView& view, const QuiverScale& scale, double unit) {
  std::string found, left_out, arrows;
  for (const ReportedCorner& corner : view.corners) {
    const Eigen::Vector2d& p = corner.found;
    if (!p.allFinite()) continue;
    const double arm = (corner.counts ? 2.6 : 5.0) * unit;
    if (corner.counts)
      found += fmt::format("M{:.2f} {:.2f}h{:.2f}m{:.2f} {:.2f}v{:.2f}", p.x() - arm, p.y(), 2.0 * arm, -arm,
                           -arm, 2.0 * arm);
    else
      left_out += fmt::format("M{:.2f} {:.2f}l{:.2f} {:.2f}m0 {:.2f}l{:.2f} {:.2f}", p.x() - arm, p.y() - arm,
                              2.0 * arm, 2.0 * arm, -2.0 * arm, -2.0 * arm, 2.0 * arm);
    if (!corner.modelled || !corner.modelled->allFinite()) continue;
    const Eigen::Vector2d arrow = scale.times * (p - *corner.modelled);
    arrows += fmt::format("M{:.2f} {:.2f}l{:.2f} {:.2f}", corner.modelled->x(), corner.modelled->y(),
                          arrow.x(), arrow.y());
  }
  return stroke(found, "#52e052", 0.9 * unit) + stroke(arrows, "#ff3b30", 1.3 * unit) +
         stroke(left_out, "#ff4df0", 1.8 * unit);
}

std::string colourOf(const ReportedReturn& echo, double limit_mm) {
  return hexOf(divergingColour(echo.residual_mm / limit_mm));
}

}  // namespace

std::string viewDrawing(const ReportedView& view, int columns, const QuiverScale& scale,
                        const std::string& id) {
  if (!view.picture) return {};
  const CalibrationPicture& picture = *view.picture;
  const Eigen::AlignedBox2d& window = picture.window;
  const double unit = unitOf(picture);
  const auto in_row = static_cast<std::size_t>(std::max(columns, 0));
  std::string content = fmt::format(
      "<image id=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
      "preserveAspectRatio=\"none\"{} href=\"{}\"/>\n",
      id, window.min().x(), window.min().y(), window.sizes().x(), window.sizes().y(),
      window.sizes().x() > kPixelsSeen ? "" : " style=\"image-rendering:pixelated\"",
      pictureUrl(picture.bytes));
  content += gridDrawing(view, in_row, unit) + orderDrawing(view, in_row, unit) +
             cornerDrawing(view, scale, unit) + partDrawing(picture, unit);
  return svgOf(window, view.file, content);
}

std::string returnsDrawing(const ReportedView& view, const ReportedCapture& capture, double limit_mm,
                           const std::string& id) {
  if (!view.picture) return {};
  const double unit = unitOf(*view.picture);
  const Eigen::AlignedBox2d& window = view.picture->window;
  std::string content = fmt::format(
      "<use href=\"#{}\"/><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
      "fill=\"#16191d\" "
      "fill-opacity=\"0.6\"/>\n",
      id, window.min().x(), window.min().y(), window.sizes().x(), window.sizes().y());
  constexpr std::size_t kFew = 30;
  const double radius = (capture.returns.size() <= kFew ? 6.0 : 2.2) * unit;
  for (const ReportedReturn& echo : capture.returns) {
    if (!echo.pixel.allFinite() || !std::isfinite(echo.residual_mm)) continue;
    content += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>\n", echo.pixel.x(),
                           echo.pixel.y(), radius,
                           echo.counts ? fmt::format("fill=\"{}\"", colourOf(echo, limit_mm))
                                       : fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{:.3f}\"",
                                                     colourOf(echo, limit_mm), 1.2 * unit));
  }
  return svgOf(view.picture->window, "laser returns on " + view.file, content);
}

std::string residualBar(double limit_mm) {
  constexpr double kLeft = 10.0, kWide = 330.0;
  constexpr int kSteps = 66;
  std::string content;
  for (int i = 0; i < kSteps; ++i) {
    content += fmt::format("<rect x=\"{:.1f}\" y=\"4\" width=\"{:.1f}\" height=\"10\" fill=\"{}\"/>",
                           kLeft + kWide * i / kSteps, kWide / kSteps + 0.3,
                           hexOf(divergingColour((2.0 * i + 1.0) / kSteps - 1.0)));
  }
  for (int i = -2; i <= 2; ++i) {
    content += fmt::format("<text x=\"{:.1f}\" y=\"27\" font-size=\"11\" text-anchor=\"{}\">{}{:g} mm</text>",
                           kLeft + kWide * (0.5 + 0.25 * i),
                           i == -2  ? "start"
                           : i == 2 ? "end"
                                    : "middle",
                           i > 0 ? "+" : "", 0.5 * i * limit_mm);
  }
  return svgOf({Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(350.0, 32.0)}, "scale of the returns' residuals",
               content);
}

double residualLimit(const CalibrationReport& report) {
  std::vector<double> sizes;
  for (const ReportedCapture& capture : report.captures) {
    for (const ReportedReturn& echo : capture.returns) {
      if (!std::isfinite(echo.residual_mm)) continue;
      if ((echo.counts && capture.counts) || report.by_first_guess)
        sizes.push_back(std::abs(echo.residual_mm));
    }
  }
  if (sizes.empty()) return 10.0;
  const auto place =
      sizes.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), place, sizes.end());
  return roundedUp(*place);
}

}  // namespace thermovox
