#include "io/thermal_picture.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "io/edge_drawing.hpp"
#include "io/picture_canvas.hpp"

namespace thermovox {
namespace {

constexpr int kUsualEdgePx = 960;  // small images are enlarged to about it
constexpr int kNarrowestPx = 360;  // narrower pictures have no room for a scale
constexpr int kScaleHeightPx = 76;
constexpr int kNoteHeightPx = 30;

void drawScale(cv::Mat& picture, int top, const TemperatureScale& scale) {
  const std::string unit =
      "\xB0"
      "C";
  const TextStyle style{.height_px = 13.0};
  drawText(picture, unit, cv::Point2d(20, top + 34), style);
  const int begin = 20 + static_cast<int>(textWidth(unit, style)) + 18;
  drawTemperatureScale(picture, {begin, top + 20, picture.cols - begin - 36, 18}, scale);
}

}  // namespace

TemperatureSpan calibratedSpan(const ThermalImage& image, double low_percentile, double high_percentile) {
  std::optional<TemperatureSpan> span;
  if (const auto& range = image.calibrated_range) {
    std::vector<float> calibrated;
    std::copy_if(image.celsius.begin(), image.celsius.end(), std::back_inserter(calibrated),
                 [&range](float celsius) { return !range->isBelow(celsius) && !range->isAbove(celsius); });
    span = percentileSpan(calibrated, low_percentile, high_percentile);
  }
  if (!span) span = percentileSpan(image.celsius, low_percentile, high_percentile);
  return span.value_or(TemperatureSpan{});
}

void writeThermalPicture(const std::filesystem::path& path, const ThermalImage& image,
                         const ThermalPictureOptions& options, Existing existing) {
  const int zoom = std::max(1, kUsualEdgePx / std::max(image.width, image.height));
  cv::Mat painted = paintTemperatures(image, {options.span, options.palette}, zoom);
  if (options.visible) drawEdges(painted, *options.visible, zoom);
  const std::vector<LegendEntry> legend = uncalibratedLegend(image, options.palette);
  const int legend_px = static_cast<int>(legend.size()) * kLegendRowPx;
  const int footer = kScaleHeightPx + legend_px + (options.note.empty() ? 0 : kNoteHeightPx);
  const int width = std::max(painted.cols, kNarrowestPx);
  cv::Mat picture(painted.rows + footer, width, CV_8UC3, cv::Scalar(32, 30, 28));
  painted.copyTo(picture(cv::Rect((width - painted.cols) / 2, 0, painted.cols, painted.rows)));
  drawScale(picture, painted.rows, {options.span, options.palette});
  drawLegend(picture, {20, painted.rows + kScaleHeightPx}, legend);
  if (!options.note.empty()) {
    const TextStyle style{.height_px = 11.0};
    drawText(picture, options.note, cv::Point2d(20, picture.rows - 14), style);
  }
  writePicture(path, picture, existing);
}

}  // namespace thermovox
