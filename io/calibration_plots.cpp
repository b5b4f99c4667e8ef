#include "io/calibration_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "io/picture_canvas.hpp"
#include "io/report_html.hpp"
#include "io/svg_text.hpp"

namespace thermovox {
namespace {

/// A corner that counts and how far it is off its model, px.
struct Residual {
  Eigen::Vector2d pixel, off;
};

std::vector<Residual> residualsOf(const CalibrationReport& report, std::size_t camera) {
  std::vector<Residual> residuals;
  for (const ReportedCapture& capture : report.captures) {
    for (const ReportedView& view : capture.views) {
      if (view.camera != camera) continue;
      for (const ReportedCorner& corner : view.corners) {
        if (!corner.counts || !corner.modelled) continue;
        const Eigen::Vector2d off = corner.found - *corner.modelled;
        if (off.allFinite()) residuals.push_back({corner.found, off});
      }
    }
  }
  return residuals;
}

/// The value below which a share of them lies; 0 of none.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The drawing of a camera's image as a frame, 340 wide.
struct ImageFrame {
  double scale = 1.0;  ///< to a px of the image
  Eigen::AlignedBox2d box;

  explicit ImageFrame(const ReportedCamera& camera)
      : scale(340.0 / std::max(1, camera.width_px)),
        box(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(340.0, scale * std::max(1, camera.height_px))) {}
  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& pixel) const {
    return scale * (pixel.array() + 0.5).matrix();
  }
  [[nodiscard]] Eigen::AlignedBox2d page() const {
    return {Eigen::Vector2d(-1.0, -1.0), box.max() + Eigen::Vector2d(1.0, 1.0)};
  }
  [[nodiscard]] std::string drawing() const {
    return fmt::format(
        "<rect x=\"0\" y=\"0\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#fff\" stroke=\"#16191d\"/>\n",
        box.max().x(), box.max().y());
  }
};

std::size_t cellOf(const Coverage& grid, const ReportedCamera& camera, const Eigen::Vector2d& pixel) {
  const double u = (pixel.x() + 0.5) / std::max(1, camera.width_px) * grid.columns;
  const double v = (pixel.y() + 0.5) / std::max(1, camera.height_px) * grid.rows;
  const int column = static_cast<int>(std::clamp(u, 0.0, grid.columns - 1.0));
  const int row = static_cast<int>(std::clamp(v, 0.0, grid.rows - 1.0));
  return static_cast<std::size_t>(row * grid.columns + column);
}

Coverage emptyGrid(const ReportedCamera& camera) {
  Coverage grid;
  grid.rows =
      std::clamp(static_cast<int>(std::lround(8.0 * camera.height_px / std::max(1, camera.width_px))), 3, 12);
  grid.corners.assign(static_cast<std::size_t>(grid.columns * grid.rows), 0);
  return grid;
}

/// The mean residual of every cell with five corners or more.
std::string meanArrows(const CalibrationReport& report, std::size_t camera, const QuiverScale& scale) {
  constexpr int kFewest = 5;
  const ImageFrame frame(report.cameras[camera]);
  Coverage grid = emptyGrid(report.cameras[camera]);
  std::vector<Eigen::Vector2d> sums(grid.corners.size(), Eigen::Vector2d::Zero()), places = sums;
  for (const Residual& residual : residualsOf(report, camera)) {
    const std::size_t cell = cellOf(grid, report.cameras[camera], residual.pixel);
    sums[cell] += residual.off;
    places[cell] += residual.pixel;
    ++grid.corners[cell];
  }
  std::string path;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (grid.corners[i] < kFewest) continue;
    const Eigen::Vector2d from = frame.at(places[i] / grid.corners[i]);
    const Eigen::Vector2d arrow = frame.scale * scale.times * sums[i] / grid.corners[i];
    path += fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}", from.x(), from.y(), arrow.x(), arrow.y());
  }
  if (path.empty()) return {};
  return "<path d=\"" + path + "\" stroke=\"#0b4f94\" stroke-width=\"2.6\" fill=\"none\"/>\n";
}

constexpr double kSigmas = 4.0;  ///< on either side of a histogram's middle

std::vector<double> componentsOf(const CalibrationReport& report, std::size_t camera) {
  std::vector<double> values;
  for (const Residual& residual : residualsOf(report, camera)) {
    values.push_back(residual.off.x());
    values.push_back(residual.off.y());
  }
  return values;
}

/// A Gaussian as high as `top` above the line that it stands on.
std::string bellDrawing(double wide, double foot, double top) {
  std::string curve;
  for (int i = 0; i <= 80; ++i) {
    const double t = kSigmas * (i / 40.0 - 1.0);
    curve += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", wide * i / 80.0,
                         foot - top * std::exp(-0.5 * t * t));
  }
  return "\n<path d=\"" + curve + "\" stroke=\"#a3120a\" stroke-width=\"1.6\" fill=\"none\"/>\n" +
         fmt::format("<line x1=\"0\" x2=\"{}\" y1=\"{}\" y2=\"{}\" stroke=\"#16191d\"/>", wide, foot, foot);
}

}  // namespace

double cornerSpacing(const CalibrationReport& report, std::size_t camera) {
  std::vector<double> steps;
  const auto columns = static_cast<std::size_t>(std::max(1, report.columns));
  for (const ReportedCapture& capture : report.captures) {
    for (const ReportedView& view : capture.views) {
      if (view.camera != camera) continue;
      for (std::size_t i = 1; i < view.corners.size(); ++i) {
        const double step = (view.corners[i].found - view.corners[i - 1].found).norm();
        if (i % columns != 0 && std::isfinite(step)) steps.push_back(step);
      }
    }
  }
  return quantile(std::move(steps), 0.5);
}

QuiverScale quiverScale(const CalibrationReport& report, std::size_t camera, double extent_px) {
  std::vector<double> sizes;
  for (const Residual& residual : residualsOf(report, camera)) sizes.push_back(residual.off.norm());
  const double large = quantile(std::move(sizes), 0.95);
  if (!(large > 1e-9) || !(extent_px > 0.0)) return {};
  return {std::max(1.0, roundedUp(0.4 * extent_px / large))};
}

std::string residualMap(const CalibrationReport& report, std::size_t camera, const QuiverScale& scale) {
  const ImageFrame frame(report.cameras[camera]);
  std::string path;
  for (const Residual& residual : residualsOf(report, camera)) {
    const Eigen::Vector2d to = frame.at(residual.pixel);
    const Eigen::Vector2d arrow = frame.scale * scale.times * residual.off;
    path += fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}", to.x(), to.y(), arrow.x(), arrow.y());
  }
  std::string content = frame.drawing();
  if (!path.empty())
    content += "<path d=\"" + path + "\" stroke=\"#d9534a\" stroke-width=\"0.6\" fill=\"none\"/>\n";
  return svgOf(frame.page(), "residuals of the " + report.cameras[camera].name,
               content + meanArrows(report, camera, scale));
}

int Coverage::covered() const {
  return static_cast<int>(std::count_if(corners.begin(), corners.end(), [](int count) { return count > 0; }));
}

Coverage coverageOf(const CalibrationReport& report, std::size_t camera) {
  Coverage grid = emptyGrid(report.cameras[camera]);
  for (const Residual& residual : residualsOf(report, camera))
    ++grid.corners[cellOf(grid, report.cameras[camera], residual.pixel)];
  return grid;
}

std::string coverageMap(const CalibrationReport& report, std::size_t camera) {
  const ImageFrame frame(report.cameras[camera]);
  const Coverage grid = coverageOf(report, camera);
  const double most = std::max(1, *std::max_element(grid.corners.begin(), grid.corners.end()));
  const double width = frame.box.max().x() / grid.columns, height = frame.box.max().y() / grid.rows;
  std::string content;
  for (std::size_t i = 0; i < grid.corners.size(); ++i) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    const double x = width * static_cast<double>(i % columns), y = height * static_cast<double>(i / columns);
    const int count = grid.corners[i];
    const Rgb colour = colourAt(Palette::cividis, 0.35 + 0.65 * count / most);
    content += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" stroke=\"#fff\" "
        "stroke-width=\"0.8\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"10\" text-anchor=\"middle\" fill=\"{}\">{}</text>\n",
        x, y, width, height, count > 0 ? hexOf(colour) : "#fdf1ef", x + 0.5 * width, y + 0.5 * height + 3.5,
        count > 0 ? "#16191d" : "#a3120a", count);
  }
  content += fmt::format(
      "<rect x=\"0\" y=\"0\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#16191d\"/>\n",
      frame.box.max().x(), frame.box.max().y());
  return svgOf(frame.page(), "coverage of the " + report.cameras[camera].name, content);
}

std::string residualHistogram(const CalibrationReport& report, std::size_t camera) {
  constexpr int kBins = 33;
  constexpr double kWide = 340.0, kFoot = 120.0, kHigh = 108.0;
  const std::vector<double> values = componentsOf(report, camera);
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  const double sigma = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, values.size())));
  if (!(sigma > 0.0)) return {};
  std::array<int, kBins> bins{};
  for (const double value : values) {
    const double place = (value / (2.0 * kSigmas * sigma) + 0.5) * kBins;
    ++bins[static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0))];
  }
  // Of a Gaussian, a bin in the middle would hold this many.
  const double bell =
      static_cast<double>(values.size()) * 2.0 * kSigmas / kBins / std::sqrt(2.0 * std::numbers::pi);
  const double scale =
      kHigh / std::max(bell, static_cast<double>(*std::max_element(bins.begin(), bins.end())));
  std::string content;
  for (int i = 0; i < kBins; ++i) {
    const double height = scale * bins[static_cast<std::size_t>(i)];
    content +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#c3ccd6\"/>",
                    kWide * i / kBins, kFoot - height, kWide / kBins - 1.0, height);
  }
  content += bellDrawing(kWide, kFoot, scale * bell);
  for (int i = -2; i <= 2; ++i) {
    content += fmt::format("<text x=\"{:.1f}\" y=\"{}\" font-size=\"11\" text-anchor=\"middle\">{}{}</text>",
                           kWide * (0.5 + 0.2 * i), kFoot + 15.0, numberText(1.6 * i * sigma, 3),
                           i == 0 ? " px" : "");
  }
  return svgOf({Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(340.0, 140.0)}, "histogram of the residuals",
               content);
}

}  // namespace thermovox
