#include "io/thermal_picture.hpp"

#include <algorithm>

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

void writeThermalPicture(const std::filesystem::path& path, const ThermalImage& image,
                         const ThermalPictureOptions& options, Existing existing) {
  const int zoom = std::max(1, kUsualEdgePx / std::max(image.width, image.height));
  cv::Mat painted = paintTemperatures(image, {options.span, options.palette}, zoom);
  if (options.visible) drawEdges(painted, *options.visible, zoom);
  const int footer = kScaleHeightPx + (options.note.empty() ? 0 : kNoteHeightPx);
  const int width = std::max(painted.cols, kNarrowestPx);
  cv::Mat picture(painted.rows + footer, width, CV_8UC3, cv::Scalar(32, 30, 28));
  painted.copyTo(picture(cv::Rect((width - painted.cols) / 2, 0, painted.cols, painted.rows)));
  drawScale(picture, painted.rows, {options.span, options.palette});
  if (!options.note.empty()) {
    const TextStyle style{.height_px = 11.0};
    drawText(picture, options.note, cv::Point2d(20, picture.rows - 14), style);
  }
  writePicture(path, picture, existing);
}

}  // namespace thermovox
