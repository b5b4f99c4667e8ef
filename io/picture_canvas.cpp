#include "io/picture_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <vector>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr int kOversampling = 4;  // strokes are drawn this much larger and averaged down
constexpr char kDegreeSign = '\xB0';
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontCapital = 21.0;  // px of a capital letter of this font at scale 1
constexpr double kDegreeWidth = 0.62;  // of a capital letter's height

struct Pen {
  double scale = 1.0;    ///< of the font, at the large size
  int thickness = 1;     ///< px, at the large size
  double capital = 1.0;  ///< px, at the large size
};

Pen penOf(const TextStyle& style) {
  const double capital = style.height_px * kOversampling;
  const double stroke = style.bold ? 0.17 : 0.115;
  return {capital / kFontCapital, std::max(1, static_cast<int>(std::lround(stroke * capital))), capital};
}

/// Text between signs of degrees, which the font does not have.
std::vector<std::string> splitAtDegrees(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == kDegreeSign) {
      parts.emplace_back();
    } else if (static_cast<unsigned char>(c) < 128) {
      parts.back() += c;
    }
  }
  return parts;
}

double partWidth(const std::string& part, const Pen& pen) {
  int baseline = 0;
  return part.empty() ? 0.0 : cv::getTextSize(part, kFont, pen.scale, pen.thickness, &baseline).width;
}

double largeWidth(const std::vector<std::string>& parts, const Pen& pen) {
  double width = kDegreeWidth * pen.capital * static_cast<double>(parts.size() - 1);
  for (const std::string& part : parts) width += partWidth(part, pen);
  return width;
}

/// How much of each pixel the strokes cover, 0..255; the baseline begins at (margin, margin + capital).
cv::Mat strokeMask(const std::vector<std::string>& parts, const Pen& pen, int margin) {
  const int width = static_cast<int>(std::ceil(largeWidth(parts, pen))) + 2 * margin;
  const int height = static_cast<int>(std::ceil(1.5 * pen.capital)) + 2 * margin;
  cv::Mat mask = cv::Mat::zeros(height, width, CV_8U);
  double x = margin;
  const double baseline = margin + pen.capital;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) {
      const double radius = 0.17 * pen.capital;
      const cv::Point center(static_cast<int>(x + 0.3 * pen.capital),
                             static_cast<int>(baseline - 0.83 * pen.capital));
      cv::circle(mask, center, static_cast<int>(radius), 255, std::max(1, 3 * pen.thickness / 4),
                 cv::LINE_AA);
      x += kDegreeWidth * pen.capital;
    }
    const cv::Point start(static_cast<int>(x), static_cast<int>(baseline));
    cv::putText(mask, parts[i], start, kFont, pen.scale, 255, pen.thickness, cv::LINE_AA);
    x += partWidth(parts[i], pen);
  }
  return mask;
}

/// Mixes the colour into the picture where the mask covers it; the mask's corner is at (left, top).
void stamp(cv::Mat& picture, const cv::Mat& mask, cv::Point corner, const Rgb& colour) {
  const cv::Vec3d ink(colour.b, colour.g, colour.r);
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const cv::Point p(corner.x + u, corner.y + v);
      const double cover = mask.at<std::uint8_t>(v, u) / 255.0;
      if (cover == 0.0 || p.x < 0 || p.y < 0 || p.x >= picture.cols || p.y >= picture.rows) continue;
      auto& pixel = picture.at<cv::Vec3b>(p);
      for (int c = 0; c < 3; ++c) {
        pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + cover * (ink[c] - pixel[c])));
      }
    }
  }
}

/// The bytes of a file that ends like this; `what` begins the message where that cannot be.
std::string encoded(const cv::Mat& picture, const char* ending, const std::string& what) {
  const std::vector<int> settings{cv::IMWRITE_JPEG_QUALITY, 95, cv::IMWRITE_PNG_COMPRESSION, 6};
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(ending, picture, bytes, settings)) {
    throw DataError(what + " could not be encoded, expected 8 bits a channel");
  }
  return {bytes.begin(), bytes.end()};
}

std::string tickText(double value, double step) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", step < 0.1 ? 2 : step < 1.0 ? 1 : 0, value + 0.0);
  return text;
}

}  // namespace

double textWidth(const std::string& text, const TextStyle& style) {
  return largeWidth(splitAtDegrees(text), penOf(style)) / kOversampling;
}

void drawText(cv::Mat& picture, const std::string& text, cv::Point2d position, const TextStyle& style) {
  const Pen pen = penOf(style);
  const int margin = 4 * kOversampling;
  cv::Mat mask = strokeMask(splitAtDegrees(text), pen, margin);
  // Pad to whole pixels, so that the averaging is even.
  cv::copyMakeBorder(mask, mask, 0, (kOversampling - mask.rows % kOversampling) % kOversampling, 0,
                     (kOversampling - mask.cols % kOversampling) % kOversampling, cv::BORDER_CONSTANT, 0);
  cv::Mat small;
  cv::resize(mask, small, mask.size() / kOversampling, 0, 0, cv::INTER_AREA);
  double left = position.x;
  if (style.align != TextAlign::left)
    left -= textWidth(text, style) * (style.align == TextAlign::right ? 1.0 : 0.5);
  const cv::Point corner(
      static_cast<int>(std::lround(left)) - margin / kOversampling,
      static_cast<int>(std::lround(position.y - style.height_px)) - margin / kOversampling);
  stamp(picture, small, corner, style.colour);
}

std::vector<double> roundTicks(const TemperatureSpan& span, int wanted) {
  const double rough = (span.high - span.low) / std::max(1, wanted);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double nice : {1.0, 2.0, 5.0}) {
    if (nice * power >= rough * 0.999) {
      step = nice * power;
      break;
    }
  }
  std::vector<double> ticks;
  const auto first = static_cast<long>(std::ceil(span.low / step - 1e-9));
  const auto last = static_cast<long>(std::floor(span.high / step + 1e-9));
  for (long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

void drawTemperatureScale(cv::Mat& picture, const cv::Rect& area, const TemperatureScale& scale) {
  for (int x = 0; x < area.width; ++x) {
    const Rgb colour = colourAt(scale.palette, (x + 0.5) / area.width);
    picture(cv::Rect(area.x + x, area.y, 1, area.height)).setTo(cv::Scalar(colour.b, colour.g, colour.r));
  }
  const cv::Scalar line(205, 205, 205);
  cv::rectangle(picture, area + cv::Size(1, 1) - cv::Point(1, 1), line, 1);
  const TextStyle style{area.height * 0.62, {205, 205, 205}, TextAlign::center, false};
  // Ticks of a bent scale crowd at its hot end: many are asked for, and those too near the last are left out.
  const std::vector<double> ticks =
      roundTicks(scale.span, std::max(2, area.width / (scale.exponent < 1.0 ? 40 : 70)));
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  double free_from = -1e9;
  for (const double tick : ticks) {
    const std::string text = tickText(tick, step);
    const double x = area.x + scale.placeOf(tick) * area.width;
    const double half = textWidth(text, style) / 2 + 0.35 * area.height;
    if (x - half < free_from) continue;
    free_from = x + half;
    const cv::Point top(static_cast<int>(std::lround(x)), area.y + area.height);
    cv::line(picture, top, top + cv::Point(0, area.height / 3), line, 1);
    drawText(picture, text, {x, area.y + 2.25 * area.height}, style);
  }
}

namespace {

/// The colour of a pixel outside the calibrated range; nullopt for all others.
std::optional<Rgb> markOf(double celsius, const CalibratedRange& range, const UncalibratedColours& colours) {
  if (range.isBelow(celsius)) return colours.below;
  return range.isAbove(celsius) ? std::optional(colours.above) : std::nullopt;
}

cv::Scalar bgr(const Rgb& colour) {
  return {static_cast<double>(colour.b), static_cast<double>(colour.g), static_cast<double>(colour.r)};
}

/// Whole pixels, so that a single one is seen too.
void markUncalibrated(cv::Mat& picture, const ThermalImage& image, Palette palette, int zoom) {
  if (!image.calibrated_range) return;
  const UncalibratedColours colours = uncalibratedColours(palette);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const auto mark = markOf(image.at(u, v), *image.calibrated_range, colours);
      if (mark) picture(cv::Rect(u * zoom, v * zoom, zoom, zoom)).setTo(bgr(*mark));
    }
  }
}

}  // namespace

cv::Mat paintTemperatures(const ThermalImage& image, const TemperatureScale& scale, int zoom) {
  cv::Mat small(image.height, image.width, CV_8UC3);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const Rgb colour = scale.colourOf(image.at(u, v));
      small.at<cv::Vec3b>(v, u) = {colour.b, colour.g, colour.r};
    }
  }
  cv::Mat large;
  cv::resize(small, large, {}, zoom, zoom, zoom > 1 ? cv::INTER_CUBIC : cv::INTER_AREA);
  markUncalibrated(large, image, scale.palette, zoom);
  return large;
}

std::vector<LegendEntry> uncalibratedLegend(const ThermalImage& image, Palette palette) {
  std::vector<LegendEntry> legend;
  if (!image.calibrated_range) return legend;
  const CalibratedRange& range = *image.calibrated_range;
  const UncalibratedColours colours = uncalibratedColours(palette);
  const auto add = [&](bool there, const Rgb& colour, const char* side, double limit) {
    if (!there) return;
    legend.push_back(
        {colour, std::string(side) + " the calibrated " + tickText(limit, 1.0) + " " + kDegreeSign + "C"});
  };
  const auto any = [&image](auto outside) {
    return std::any_of(image.celsius.begin(), image.celsius.end(), outside);
  };
  add(any([&range](float celsius) { return range.isBelow(celsius); }), colours.below, "below", range.low);
  add(any([&range](float celsius) { return range.isAbove(celsius); }), colours.above, "above", range.high);
  return legend;
}

void drawLegend(cv::Mat& picture, cv::Point corner, std::span<const LegendEntry> entries) {
  constexpr int patch = 14;  // px
  for (const LegendEntry& entry : entries) {
    const cv::Rect area(corner.x, corner.y + 3, patch, patch);
    cv::rectangle(picture, area, bgr(entry.colour), cv::FILLED);
    drawText(picture, entry.meaning, cv::Point2d(corner.x + patch + 10, corner.y + 15), {.height_px = 11.0});
    corner.y += kLegendRowPx;
  }
}

std::string pngOf(const cv::Mat& picture) {
  return encoded(picture, ".png", "a picture");
}

std::string jpegOf(const cv::Mat& picture) {
  return encoded(picture, ".jpg", "a picture");
}

void writePicture(const std::filesystem::path& path, const cv::Mat& picture, Existing existing) {
  const std::string ending = endingOf(path);
  const bool jpeg = ending == ".jpg" || ending == ".jpeg";
  const std::string bytes = encoded(picture, jpeg ? ".jpg" : ".png", path.string() + ": the picture");
  AtomicFile file(path, existing);
  file.write(bytes);
  file.commit();
}

}  // namespace thermovox
