#include "calibration/circle_middles.hpp"

#include <gtest/gtest.h>

#include "calibration/local_normalisation.hpp"
#include "tests/calibration/rendered_circles.hpp"

namespace thermovox::test {
namespace {

/// A board without noise, its middles on the board, and the middles of the ellipses that its circles are seen
/// as: by the mean of points on their edge, which are dense enough for a polygon's area.
struct Seen {
  RenderedCircles board = tiltedCircles(40.0, 15.0);
  Pixels on_board, ellipses;

  Seen() {
    board.noise = 0.0;
    for (int i = 0; i < board.columns * board.rows; ++i) {
      const Eigen::Vector2d middle(2 * (i % board.columns) + i / board.columns % 2, i / board.columns);
      on_board.emplace_back(static_cast<float>(middle.x()), static_cast<float>(middle.y()));
      ellipses.push_back(middleOfEdge(middle));
    }
  }
  [[nodiscard]] cv::Point2f middleOfEdge(const Eigen::Vector2d& middle) const {
    Pixels edge;
    for (int k = 0; k < 360; ++k) {
      const double angle = k * M_PI / 180.0;
      const Eigen::Vector2d point = middle + board.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const Eigen::Vector2d pixel = (board.pixel_from_board * point.homogeneous()).hnormalized();
      edge.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    }
    const cv::Moments moments = cv::moments(edge);
    return {static_cast<float>(moments.m10 / moments.m00), static_cast<float>(moments.m01 / moments.m00)};
  }
  [[nodiscard]] double worst(const Pixels& pixels) const {
    double worst = 0.0;
    for (int i = 0; i < board.columns * board.rows; ++i) {
      const cv::Point2f& pixel = pixels[static_cast<std::size_t>(i)];
      worst = std::max(
          worst,
          (Eigen::Vector2d(pixel.x, pixel.y) - board.middleAt(i % board.columns, i / board.columns)).norm());
    }
    return worst;
  }
};

TEST(CircleMiddles, AreNotThoseOfTheEllipses) {
  const Seen seen;
  const BoardImage image = imageOf(seen.board);
  EXPECT_GT(seen.worst(seen.ellipses), 0.15);
  EXPECT_LT(seen.worst(circleMiddles(asMat(image), seen.ellipses, seen.on_board).middles), 0.015);
}

TEST(CircleMiddles, OfAnImageWithoutCirclesStay) {
  const Seen seen;
  const BoardImage plain{160, 120, std::vector<float>(160 * 120, 25.0F)};
  EXPECT_EQ(circleMiddles(asMat(plain), seen.ellipses, seen.on_board).middles, seen.ellipses);
}

}  // namespace
}  // namespace thermovox::test
