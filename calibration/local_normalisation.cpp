#include "calibration/local_normalisation.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace thermovox {
namespace {

constexpr double kPixelNoise = 0.6;    // px, sigma of the Gaussian that takes a pixel's noise off
constexpr double kLeastSpread = 1e-3;  // of the largest one
constexpr double kRounding = 1e-5;     // of the image's values, that single precision makes of a plain one
constexpr double kGain = 55.0;         // grey levels a standard deviation

cv::Mat blurred(const cv::Mat& image, double sigma_px) {
  cv::Mat result;
  cv::GaussianBlur(image, result, {}, sigma_px, sigma_px, cv::BORDER_REFLECT_101);
  return result;
}

}  // namespace

cv::Mat asMat(const BoardImage& image) {
  // Read only: nothing of OpenCV writes into it here.
  return {image.height, image.width, CV_32F, const_cast<float*>(image.values.data())};
}

cv::Mat locallyNormalised(const cv::Mat& image, double sigma_px) {
  const cv::Mat detail = blurred(image, kPixelNoise) - blurred(image, sigma_px);
  cv::Mat spread;
  cv::sqrt(blurred(detail.mul(detail), 1.5 * sigma_px), spread);
  double most = 0.0;
  cv::minMaxLoc(spread, nullptr, &most);
  const double rounding = kRounding * cv::norm(image, cv::NORM_INF);
  const cv::Mat safe = cv::max(spread, std::max({kLeastSpread * most, rounding, 1e-30}));
  cv::Mat grey;
  cv::Mat(detail / safe).convertTo(grey, CV_8U, kGain, 127.0);
  return grey;
}

cv::Mat stretched(const cv::Mat& image) {
  std::vector<float> values(image.begin<float>(), image.end<float>());
  const auto at = [&](double share) {
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return static_cast<double>(*place);
  };
  const double low = at(0.02), high = std::max(at(0.98), low + 1e-30);
  cv::Mat grey;
  image.convertTo(grey, CV_8U, 255.0 / (high - low), -255.0 * low / (high - low));
  return grey;
}

}  // namespace thermovox
