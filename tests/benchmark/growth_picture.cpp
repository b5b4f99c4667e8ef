#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "io/picture_canvas.hpp"
#include "tests/benchmark/growth.hpp"

namespace thermovox::bench {
namespace {

const cv::Scalar kBackground(30, 26, 24), kGrid(70, 64, 60), kCurve(80, 170, 255), kLine(200, 200, 200);
constexpr int kSupersampling = 16;  // OpenCV draws to a fraction of a pixel
constexpr int kShift = 4;

/// A diagram: its place in the picture, px, and what its right and upper ends stand for.
struct Panel {
  cv::Rect area;
  std::string title;
  double x_end = 1.0, y_end = 1.0;

  [[nodiscard]] cv::Point2d at(double x, double y) const {
    return {area.x + area.width * x / x_end, area.y + area.height * (1.0 - y / y_end)};
  }
};

void drawStroke(cv::Mat& picture, const cv::Point2d& from, const cv::Point2d& to, const cv::Scalar& colour,
                int thickness) {
  const auto fixed = [](const cv::Point2d& p) {
    return cv::Point(cvRound(p.x * kSupersampling), cvRound(p.y * kSupersampling));
  };
  cv::line(picture, fixed(from), fixed(to), colour, thickness, cv::LINE_AA, kShift);
}

void drawAxes(cv::Mat& picture, const Panel& panel) {
  const TextStyle small{.height_px = 10.0, .align = TextAlign::center};
  for (const double x : roundTicks({0.0, panel.x_end}, 5)) {
    drawStroke(picture, panel.at(x, 0.0), panel.at(x, panel.y_end), kGrid, 1);
    drawText(picture, fmt::format("{:g}", x), panel.at(x, 0.0) + cv::Point2d(0.0, 20.0), small);
  }
  for (const double y : roundTicks({0.0, panel.y_end}, 5)) {
    drawStroke(picture, panel.at(0.0, y), panel.at(panel.x_end, y), kGrid, 1);
    drawText(picture, fmt::format("{:g}", y), panel.at(0.0, y) + cv::Point2d(-8.0, 5.0),
             {.height_px = 10.0, .align = TextAlign::right});
  }
  drawText(picture, panel.title, cv::Point2d(panel.area.x, panel.area.y - 14.0), {.height_px = 12.0});
  drawText(picture, "scans", panel.at(panel.x_end / 2, 0.0) + cv::Point2d(0.0, 40.0), small);
}

void drawCurve(cv::Mat& picture, const Panel& panel, const std::vector<GrowthPoint>& curve,
               double GrowthPoint::*value) {
  cv::Point2d before = panel.at(0.0, 0.0);
  for (const GrowthPoint& point : curve) {
    const cv::Point2d here = panel.at(point.scans, point.*value);
    drawStroke(picture, before, here, kCurve, 2);
    before = here;
  }
}

}  // namespace

void writeGrowthPicture(const std::filesystem::path& path, const std::vector<GrowthPoint>& curve) {
  cv::Mat picture(360, 960, CV_8UC3, kBackground);
  const GrowthPoint& last = curve.back();
  const Linearity line = linearity(curve);
  double most_memory = 0.0;
  for (const GrowthPoint& point : curve) most_memory = std::max(most_memory, point.memory_mb);
  const Panel time{{70, 50, 370, 250},
                   "total processor time, s; white: straight line",
                   1.0 * last.scans,
                   1.1 * last.total_cpu_s};
  const Panel memory{
      {560, 50, 370, 250}, "resident memory of the map, MB", 1.0 * last.scans, 1.1 * most_memory};
  drawAxes(picture, time);
  drawAxes(picture, memory);
  drawCurve(picture, time, curve, &GrowthPoint::total_cpu_s);
  drawStroke(picture, time.at(0.0, 0.0), time.at(last.scans, line.seconds_a_scan * last.scans), kLine, 1);
  drawCurve(picture, memory, curve, &GrowthPoint::memory_mb);
  writePicture(path, picture, Existing::replace);
}

}  // namespace thermovox::bench
