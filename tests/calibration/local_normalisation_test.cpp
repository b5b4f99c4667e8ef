#include "calibration/local_normalisation.hpp"

#include <gtest/gtest.h>

#include "tests/calibration/rendered_board.hpp"

namespace thermovox::test {
namespace {

TEST(LocalNormalisation, TakesAGradientAway) {
  const RenderedBoard board{.pixel_from_board = homographyOf(10.0, 0.0, {35.0, 30.0}), .warm = 4.0};
  BoardImage flat = imageOf(board), sloping = flat;
  for (int v = 0; v < flat.height; ++v) {
    for (int u = 0; u < flat.width; ++u) {
      sloping.values[static_cast<std::size_t>(v * flat.width + u)] +=
          static_cast<float>(0.2 * u);  // 32 C across
    }
  }
  const cv::Mat one = locallyNormalised(asMat(flat), 4.0), other = locallyNormalised(asMat(sloping), 4.0);
  cv::Mat difference;
  const cv::Rect inside(30, 25, 90, 60);
  cv::absdiff(one(inside), other(inside), difference);
  EXPECT_LT(cv::mean(difference)[0], 6.0);  // of 256 grey levels
  EXPECT_GT(cv::mean(one(inside))[0], 100.0);
}

TEST(LocalNormalisation, OfAPlainImageIsGrey) {
  const BoardImage plain{20, 10, std::vector<float>(200, 300.0F)};
  const cv::Mat grey = locallyNormalised(asMat(plain), 4.0);
  double low = 0.0, high = 0.0;
  cv::minMaxLoc(grey, &low, &high);
  EXPECT_NEAR(low, 127.0, 2.0);
  EXPECT_NEAR(high, 127.0, 2.0);
  EXPECT_EQ(stretched(asMat(plain)).type(), CV_8U);
}

}  // namespace
}  // namespace thermovox::test
