#include "io/map_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "io/picture_canvas.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// "123 456".
std::string grouped(std::size_t number) {
  std::string text = std::to_string(number);
  for (std::ptrdiff_t i = std::ssize(text) - 3; i > 0; i -= 3)
    text.insert(static_cast<std::size_t>(i), 1, ' ');
  return text;
}

void writeCaptions(cv::Mat& picture, std::span<const SurfacePoint> points, const MapPictureOptions& options,
                   const TemperatureScale& scale) {
  const double unit = picture.rows / 900.0;
  const auto with_temperature = static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [](const SurfacePoint& p) { return p.temperature.has_value(); }));
  drawText(picture, options.title, {44 * unit, 62 * unit},
           {22 * unit, {240, 240, 240}, TextAlign::left, true});
  char detail[200];
  std::snprintf(detail, sizeof detail,
                "%s surface cells of %.3g cm, %.0f %% with temperature, %.1f to %.1f \xB0"
                "C",
                grouped(points.size()).c_str(), 100.0 * options.resolution,
                100.0 * static_cast<double>(with_temperature) / static_cast<double>(points.size()),
                scale.span.low, scale.span.high);
  drawText(picture, detail, {44 * unit, 92 * unit}, {11 * unit, {165, 168, 173}, TextAlign::left, false});
  if (with_temperature == 0) return;
  const auto px = [unit](double value) { return static_cast<int>(std::lround(value * unit)); };
  const cv::Rect bar(picture.cols - px(44 + 440), px(50), px(440), px(17));
  drawTemperatureScale(picture, bar, scale);
  drawText(picture,
           "surface temperature, \xB0"
           "C",
           {bar.x - 22 * unit, bar.y + 0.85 * bar.height},
           {11.5 * unit, {205, 205, 205}, TextAlign::right, false});
}

}  // namespace

void writeMapPicture(const std::filesystem::path& path, std::span<const SurfacePoint> points,
                     const MapPictureOptions& options, Existing existing) {
  options.validate();
  if (points.empty()) throw DataError(path.string() + ": the map holds no surface, expected points to draw");
  checkOutput(path, existing);
  MapView drawn = drawMap(points, options);
  const cv::Mat rgb(drawn.picture.height, drawn.picture.width, CV_8UC3, drawn.picture.rgb.data());
  cv::Mat picture;
  cv::cvtColor(rgb, picture, cv::COLOR_RGB2BGR);
  writeCaptions(picture, points, options, drawn.scale);
  writePicture(path, picture, existing);
}

}  // namespace thermovox
