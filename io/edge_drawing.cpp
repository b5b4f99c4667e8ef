#include "io/edge_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace thermovox {
namespace {

/// Luminance less its surroundings, 0 near the rim of what is covered.
cv::Mat highPass(const ResampledPicture& picture, int zoom) {
  const cv::Mat luminance(picture.height, picture.width, CV_8U,
                          const_cast<std::uint8_t*>(picture.luminance.data()));
  const cv::Mat covered(picture.height, picture.width, CV_8U,
                        const_cast<std::uint8_t*>(picture.covered.data()));
  const double sigma = std::max(1.0, 0.4 * zoom);
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  cv::Mat surroundings, inner, edges;
  cv::GaussianBlur(luminance, surroundings, {2 * reach + 1, 2 * reach + 1}, sigma);
  cv::erode(covered, inner, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U), {-1, -1}, 1,
            cv::BORDER_REPLICATE);
  cv::subtract(luminance, surroundings, edges, inner, CV_16S);
  edges.setTo(0, inner == 0);
  return edges;
}

/// The strength that only one in fifty of the edges' pixels exceeds, in levels.
int strongEdge(const cv::Mat& edges) {
  std::vector<int> strengths;
  for (auto edge = edges.begin<std::int16_t>(); edge != edges.end<std::int16_t>(); ++edge) {
    if (*edge != 0) strengths.push_back(std::abs(*edge));
  }
  if (strengths.empty()) return 0;
  const auto rank = strengths.begin() + static_cast<std::ptrdiff_t>(strengths.size() * 49 / 50);
  std::nth_element(strengths.begin(), rank, strengths.end());
  return *rank;
}

}  // namespace

void drawEdges(cv::Mat& painted, const RegisteredPicture& visible, int zoom) {
  constexpr int kNoise = 2;            // levels of the visible picture that are no edge
  constexpr double kInk = 90.0;        // levels that a strong edge lightens or darkens the picture by
  constexpr double kLargestGain = 12;  // of an even picture's faint edges
  constexpr double kMostInk = 130.0;
  const cv::Mat edges = highPass(resample(visible, zoom), zoom);
  const double gain = std::min(kLargestGain, kInk / std::max(1, strongEdge(edges)));
  for (int y = 0; y < painted.rows; ++y) {
    for (int x = 0; x < painted.cols; ++x) {
      const int edge = edges.at<std::int16_t>(y, x);
      const int strength = std::max(0, std::abs(edge) - kNoise);
      const int ink =
          static_cast<int>(std::lround(std::min(kMostInk, gain * strength))) * (edge < 0 ? -1 : 1);
      auto& pixel = painted.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<std::uint8_t>(pixel[c] + ink);
    }
  }
}

}  // namespace thermovox
