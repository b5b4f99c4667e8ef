#include "io/edge_drawing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace thermovox::test {
namespace {

constexpr int kWidth = 60, kHeight = 40, kZoom = 4;

/// A visible picture that is bright from the column on, seen pixel by pixel by the thermal image.
RegisteredPicture step(int column, int dark, int bright) {
  RegisteredPicture visible{{kWidth, kHeight, {}}, {kWidth, kHeight, {}}};
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      visible.picture.luminance.push_back(static_cast<std::uint8_t>(u < column ? dark : bright));
      visible.pixels.pixels.emplace_back(u, v);
    }
  }
  return visible;
}

cv::Mat drawn(const RegisteredPicture& visible) {
  cv::Mat painted(kHeight * kZoom, kWidth * kZoom, CV_8UC3, cv::Scalar(120, 120, 120));
  drawEdges(painted, visible, kZoom);
  return painted;
}

int levelAt(const cv::Mat& picture, int x, int y) {
  return picture.at<cv::Vec3b>(y, x)[0];
}

TEST(DrawEdges, AStepIsADarkAndALightLineWhereItIs) {
  const cv::Mat picture = drawn(step(30, 60, 160));
  const int edge = 30 * kZoom, y = 80;
  int darkest = 0, lightest = 0;
  for (int x = 0; x < picture.cols; ++x) {
    if (levelAt(picture, x, y) < levelAt(picture, darkest, y)) darkest = x;
    if (levelAt(picture, x, y) > levelAt(picture, lightest, y)) lightest = x;
  }
  EXPECT_NEAR(darkest, edge, kZoom);
  EXPECT_NEAR(lightest, edge, kZoom);
  EXPECT_LT(darkest, lightest);
  EXPECT_LT(levelAt(picture, darkest, y), 100);
  EXPECT_GT(levelAt(picture, lightest, y), 140);
  EXPECT_EQ(levelAt(picture, edge - 30, y), 120);
  EXPECT_EQ(levelAt(picture, edge + 30, y), 120);
}

// A fifth of the strong step.
TEST(DrawEdges, AFaintStepIsClearerThanInProportion) {
  const cv::Mat faint = drawn(step(30, 60, 100)), strong = drawn(step(30, 20, 220));
  EXPECT_GT(
      cv::norm(faint, cv::Mat(faint.size(), CV_8UC3, cv::Scalar(120, 120, 120)), cv::NORM_INF),
      0.27 * cv::norm(strong, cv::Mat(strong.size(), CV_8UC3, cv::Scalar(120, 120, 120)), cv::NORM_INF));
}

TEST(DrawEdges, AnEvenPictureAndTheRimOfTheVisibleOneLeaveNoLine) {
  const cv::Mat before(kHeight * kZoom, kWidth * kZoom, CV_8UC3, cv::Scalar(120, 120, 120));
  RegisteredPicture even = step(0, 60, 200);
  EXPECT_EQ(cv::norm(drawn(even), before, cv::NORM_INF), 0.0);
  for (Eigen::Vector2d& pixel : even.pixels.pixels) pixel.x() += 25.0;
  EXPECT_EQ(cv::norm(drawn(even), before, cv::NORM_INF), 0.0);
  for (Eigen::Vector2d& pixel : even.pixels.pixels) pixel.x() = std::nan("");
  EXPECT_EQ(cv::norm(drawn(even), before, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace thermovox::test
