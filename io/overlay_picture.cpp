#include "io/overlay_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "io/edge_drawing.hpp"
#include "io/picture_canvas.hpp"
#include "io/thermal_picture.hpp"

namespace thermovox {
namespace {

constexpr int kHeaderPx = 56;
constexpr int kFooterPx = 84;
constexpr Palette kDistancePalette = Palette::rainbow;

cv::Scalar bgr(const Rgb& colour) {
  return {static_cast<double>(colour.b), static_cast<double>(colour.g), static_cast<double>(colour.r)};
}

TemperatureSpan distanceSpan(std::span<const OverlayPoint> points) {
  TemperatureSpan span{0.0, 1.0};
  if (points.empty()) return span;
  const auto [near, far] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.range < b.range; });
  span = {near->range, far->range};
  if (span.high - span.low < 0.5) span = {span.low - 0.25, span.high + 0.25};
  return span;
}

/// Place in the picture of a pixel of the image, whose centres are whole numbers.
cv::Point2d placeOf(const Eigen::Vector2d& pixel, int zoom) {
  return {(pixel.x() + 0.5) * zoom, kHeaderPx + (pixel.y() + 0.5) * zoom};
}

void drawDot(cv::Mat& picture, cv::Point2d place, double radius, const cv::Scalar& colour) {
  constexpr int shift = 4;  // sixteenths of a pixel
  const cv::Point center(static_cast<int>(place.x * 16), static_cast<int>(place.y * 16));
  cv::circle(picture, center, static_cast<int>((radius + 1.2) * 16), cv::Scalar(20, 20, 20), cv::FILLED,
             cv::LINE_AA, shift);
  cv::circle(picture, center, static_cast<int>(radius * 16), colour, cv::FILLED, cv::LINE_AA, shift);
}

/// A ring about the point and a plate beside it with two lines; the plate stays inside the image.
void drawChosen(cv::Mat& picture, const OverlayPoint& point, cv::Point2d place, const cv::Rect& image_area) {
  const std::string first = fmt::format(
      "{:.1f} \xB0"
      "C",
      point.celsius);
  const std::string second = fmt::format("{:.2f} m  {}", point.range, point.label);
  const TextStyle style{.height_px = 14.0};
  const int width = static_cast<int>(std::max(textWidth(first, style), textWidth(second, style))) + 20;
  const int height = 58;
  int left = static_cast<int>(place.x) + 18;
  if (left + width > image_area.br().x) left = static_cast<int>(place.x) - 18 - width;
  const int top =
      std::clamp(static_cast<int>(place.y) - height / 2, image_area.y, image_area.br().y - height);
  const cv::Rect plate = cv::Rect(left, top, width, height) & image_area;
  if (plate.area() == 0) return;
  cv::Mat(picture(plate)) *= 0.25;
  drawText(picture, first, cv::Point2d(left + 10, top + 24), style);
  drawText(picture, second, cv::Point2d(left + 10, top + 48), style);
  cv::circle(picture, place, 11, cv::Scalar(20, 20, 20), 4, cv::LINE_AA);
  cv::circle(picture, place, 11, cv::Scalar(245, 245, 245), 2, cv::LINE_AA);
}

/// In the footer, which begins at the row `footer`.
void drawScales(cv::Mat& picture, int footer, const TemperatureScale& temperatures,
                const TemperatureSpan& distances) {
  const int top = footer + 22;
  const int half = picture.cols / 2;
  const TextStyle style{.height_px = 13.0};
  const auto scale = [&](int left, const std::string& unit, const TemperatureScale& values) {
    drawText(picture, unit, cv::Point2d(left, top + 14), style);
    const int begin = left + static_cast<int>(textWidth(unit, style)) + 18;
    drawTemperatureScale(picture, {begin, top, half - (begin - left) - 48, 18}, values);
  };
  scale(24,
        "surface, \xB0"
        "C",
        temperatures);
  scale(half + 24, "distance, m", {distances, kDistancePalette});
}

}  // namespace

void writeOverlayPicture(const std::filesystem::path& path, const ThermalImage& image,
                         std::span<const OverlayPoint> points, const OverlayOptions& options,
                         Existing existing) {
  const int zoom = std::max(1, options.width_px / std::max(1, image.width));
  const TemperatureSpan span = options.span ? *options.span : calibratedSpan(image, 1.0, 99.9);
  const TemperatureSpan distances = distanceSpan(points);
  const cv::Rect image_area(0, kHeaderPx, image.width * zoom, image.height * zoom);
  const std::vector<LegendEntry> legend = uncalibratedLegend(image, options.palette);
  const int above_legend = image_area.br().y + kFooterPx;
  cv::Mat picture(above_legend + static_cast<int>(legend.size()) * kLegendRowPx, image_area.width, CV_8UC3,
                  cv::Scalar(32, 30, 28));
  cv::Mat painted = paintTemperatures(image, {span, options.palette}, zoom);
  if (options.visible) drawEdges(painted, *options.visible, zoom);
  painted.copyTo(picture(image_area));
  const double radius = std::clamp(0.3 * zoom, 1.5, 3.5);
  for (const OverlayPoint& point : points) {
    drawDot(picture, placeOf(point.pixel, zoom), radius,
            bgr(colourOf(point.range, distances, kDistancePalette)));
  }
  for (const OverlayPoint& point : points) {
    if (!point.label.empty()) drawChosen(picture, point, placeOf(point.pixel, zoom), image_area);
  }
  drawText(picture, options.title, cv::Point2d(24, 36), {.height_px = 18.0, .bold = true});
  drawScales(picture, image_area.br().y, {span, options.palette}, distances);
  drawLegend(picture, {24, above_legend}, legend);
  writePicture(path, picture, existing);
}

}  // namespace thermovox
