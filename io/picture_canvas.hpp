#pragma once

// The adapter between pictures and OpenCV: only the sources of pictures include it.

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/palette.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

enum class TextAlign { left, center, right };

struct TextStyle {
  double height_px = 16.0;  ///< of a capital letter
  Rgb colour{230, 230, 230};
  TextAlign align = TextAlign::left;
  bool bold = false;
};

/// Writes one line with smooth edges; (x, y) is the baseline's left end, middle or right end by the style's
/// align. The byte 0xB0 is the sign of degrees; other bytes beyond ASCII are left out. `picture`: 8-bit BGR.
void drawText(cv::Mat& picture, const std::string& text, cv::Point2d position, const TextStyle& style);
/// Width of such a line, px.
[[nodiscard]] double textWidth(const std::string& text, const TextStyle& style);

/// A horizontal bar of the palette with ticks at round temperatures; `area` is the coloured bar, the
/// numbers stand below it.
void drawTemperatureScale(cv::Mat& picture, const cv::Rect& area, const TemperatureScale& scale);

/// Temperatures at round steps within the span, about `wanted` of them.
[[nodiscard]] std::vector<double> roundTicks(const TemperatureSpan& span, int wanted);

/// The image by the scale's colours, 8-bit BGR, `zoom` times as large. Pixels outside the image's calibrated
/// range have uncalibratedColours().
[[nodiscard]] cv::Mat paintTemperatures(const ThermalImage& image, const TemperatureScale& scale, int zoom);

/// A patch of colour and what it means.
struct LegendEntry {
  Rgb colour;
  std::string meaning;
};

/// What paintTemperatures() marks in this image: below the calibrated range, above it, both or nothing.
[[nodiscard]] std::vector<LegendEntry> uncalibratedLegend(const ThermalImage& image, Palette palette);

inline constexpr int kLegendRowPx = 24;
/// Draws the entries below one another, a row each, the first one's upper left corner at `corner`.
void drawLegend(cv::Mat& picture, cv::Point corner, std::span<const LegendEntry> entries);

/// The bytes of a PNG of the picture (8-bit BGR or grey).
[[nodiscard]] std::string pngOf(const cv::Mat& picture);
/// The same of a JPEG, for photographs.
[[nodiscard]] std::string jpegOf(const cv::Mat& picture);

/// Writes a picture (8-bit BGR or grey) as PNG, or as JPEG where the path ends on .jpg or .jpeg; whole or not
/// at all. Throws DataError naming the file.
void writePicture(const std::filesystem::path& path, const cv::Mat& picture, Existing existing);

}  // namespace thermovox
