#include "io/report_drawings.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "io/picture_canvas.hpp"
#include "io/report_html.hpp"

namespace thermovox {
namespace {

/// 95 % of chi squared with three degrees of freedom: the shadow of the ellipsoid, not of two of its axes.
constexpr double kChi95 = 7.815;

std::string image(int width_px, int height_px, const std::string& bytes) {
  return fmt::format("<image width=\"{}\" height=\"{}\" href=\"{}\"/>\n", width_px, height_px,
                     pictureUrl(bytes));
}

std::string image(const ReportPicture& picture) {
  return image(picture.width_px, picture.height_px, picture.png);
}

std::string svg(double width, double height, const std::string& label, const std::string& content) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" "
             "aria-label=\"{}\" font-family=\"Liberation Sans, Arial, sans-serif\">\n",
             width, height, escaped(label)) +
         content + "</svg>\n";
}

/// A bar of the palette from x on with ticks below, `text` px high letters.
std::string scaleBar(const TemperatureScale& scale, const cv::Rect2d& bar, double text) {
  constexpr int kSteps = 64;
  std::string drawing;
  for (int i = 0; i < kSteps; ++i) {
    const Rgb c = colourAt(scale.palette, (i + 0.5) / kSteps);
    const double left = bar.x + bar.width * i / kSteps;
    drawing += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{:.1f}\" fill=\"#{:02x}{:02x}{:02x}\"/>",
        left, bar.y, std::min(bar.width / kSteps + 0.6, bar.x + bar.width - left), bar.height, c.r, c.g, c.b);
  }
  double right = bar.x - bar.width;  // where the last number ends
  for (const double tick : roundTicks(scale.span, 6)) {
    const double x = bar.x + bar.width * scale.placeOf(tick);
    const std::string number = fmt::format("{:g}", tick);
    const double half = 0.3 * text * static_cast<double>(number.size());
    if (x - half < right) continue;
    right = x + half + 0.4 * text;
    drawing += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\" stroke=\"#16191d\"/>"
        "<text x=\"{0:.1f}\" y=\"{3:.1f}\" font-size=\"{4:.0f}\" text-anchor=\"middle\">{5}</text>",
        x, bar.y + bar.height, bar.y + bar.height + 0.3 * text, bar.y + bar.height + 1.35 * text, text,
        number);
  }
  return drawing + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.0f}\">&deg;C</text>\n",
                               bar.x + bar.width + 0.5 * text, bar.y + 0.9 * bar.height, text);
}

std::optional<Eigen::Vector2d> pixelOf(const PictureView& view, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p = view.T_world_view.inverse() * p_world;
  if (!(p.z() > 0.0)) return std::nullopt;
  return Eigen::Vector2d(view.center_x_px + view.focal_px * p.x() / p.z(),
                         view.center_y_px + view.focal_px * p.y() / p.z());
}

constexpr double kRing = 13.0;     ///< radius of a mark, px
constexpr double kLetters = 22.0;  ///< size of its number, px

/// Finds places for numbers beside their marks.
class Labels {
 public:
  Labels(double width, double height) : page_(Eigen::Vector2d::Zero(), Eigen::Vector2d(width, height)) {}

  void avoid(const Eigen::Vector2d& mark) { taken_.emplace_back(mark.array() - kRing, mark.array() + kRing); }

  /// Middle of the number's box: the nearest free place around the mark.
  Eigen::Vector2d place(const Eigen::Vector2d& mark, const Eigen::Vector2d& size) {
    constexpr std::array<double, 8> kTurns{-0.25, -0.75, 0.25, 0.75, 0.0, 1.0, -0.5, 0.5};  // of pi
    for (double distance = kRing + 6.0; distance < 140.0; distance += 10.0) {
      for (const double turn : kTurns) {
        const Eigen::Vector2d direction(std::cos(turn * std::numbers::pi), std::sin(turn * std::numbers::pi));
        const Eigen::Vector2d middle = mark + distance * direction + direction.cwiseProduct(0.5 * size);
        const Eigen::AlignedBox2d box(middle - 0.5 * size, middle + 0.5 * size);
        if (!page_.contains(box) || std::any_of(taken_.begin(), taken_.end(),
                                                [&](const auto& other) { return other.intersects(box); }))
          continue;
        taken_.push_back(box);
        return middle;
      }
    }
    return mark + Eigen::Vector2d(0.0, -kRing - 6.0 - 0.5 * size.y());
  }

 private:
  Eigen::AlignedBox2d page_;
  std::vector<Eigen::AlignedBox2d> taken_;
};

std::string markDrawing(int id, const Eigen::Vector2d& mark, Labels& labels) {
  const std::string number = std::to_string(id);
  const Eigen::Vector2d size(0.6 * kLetters * static_cast<double>(number.size()) + 8.0, kLetters + 2.0);
  const Eigen::Vector2d middle = labels.place(mark, size);
  return fmt::format(
      "<a href=\"#spot-{0}\"><line x1=\"{1:.1f}\" y1=\"{2:.1f}\" x2=\"{3:.1f}\" y2=\"{4:.1f}\" "
      "stroke=\"#0b4f94\" stroke-width=\"2\"/>"
      "<circle cx=\"{1:.1f}\" cy=\"{2:.1f}\" r=\"{5:.1f}\" fill=\"none\" stroke=\"#fff\" stroke-width=\"5\"/>"
      "<circle cx=\"{1:.1f}\" cy=\"{2:.1f}\" r=\"{5:.1f}\" fill=\"none\" stroke=\"#0b4f94\" "
      "stroke-width=\"3\"/>"
      "<rect x=\"{6:.1f}\" y=\"{7:.1f}\" width=\"{8:.1f}\" height=\"{9:.1f}\" rx=\"4\" fill=\"#fff\" "
      "stroke=\"#0b4f94\" stroke-width=\"2\"/>"
      "<text x=\"{3:.1f}\" y=\"{10:.1f}\" font-size=\"{11:.0f}\" font-weight=\"bold\" fill=\"#0b4f94\" "
      "text-anchor=\"middle\">{0}</text></a>\n",
      id, mark.x(), mark.y(), middle.x(), middle.y(), kRing, middle.x() - 0.5 * size.x(),
      middle.y() - 0.5 * size.y(), size.x(), size.y(), middle.y() + 0.36 * kLetters, kLetters);
}

/// The longest of 1, 2, 5 times a power of ten that is no longer than this.
double roundLength(double most) {
  double round = 1e-3;
  for (double decade = 1e-3; decade < 1e3; decade *= 10.0) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      if (digit * decade <= most * (1.0 + 1e-9)) round = digit * decade;
    }
  }
  return round;
}

/// The ellipse that a 95 % ellipsoid throws onto the picture, about its middle.
std::string ellipseDrawing(const SpotPicture& drawn, const Hotspot& spot, double middle) {
  const Eigen::Matrix2d shadow =
      drawn.px_from_world * spot.position.covariance() * drawn.px_from_world.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(0.5 * (shadow + shadow.transpose()));
  const Eigen::Vector2d half = (kChi95 * axes.eigenvalues().cwiseMax(0.0)).cwiseSqrt();
  const Eigen::Vector2d longer = axes.eigenvectors().col(1);
  const double turn = std::atan2(longer.y(), longer.x()) * 180.0 / std::numbers::pi;
  std::string drawing;
  for (const auto& [colour, width] : {std::pair{"#fff", 3.0}, std::pair{"#0b4f94", 1.4}}) {
    drawing += fmt::format(
        "<ellipse cx=\"{0:.1f}\" cy=\"{0:.1f}\" rx=\"{1:.2f}\" ry=\"{2:.2f}\" transform=\"rotate({3:.1f} "
        "{0:.1f} {0:.1f})\" fill=\"none\" stroke=\"{4}\" stroke-width=\"{5}\"/>\n",
        middle, std::max(half.y(), 0.8), std::max(half.x(), 0.8), turn, colour, width);
  }
  return drawing;
}

}  // namespace

std::string mapDrawing(const MapView& drawn, std::span<const MapMark> marks, const std::string& label) {
  const ReportPicture picture = pictureOf(drawn);
  const double width = picture.width_px;
  const double height = picture.height_px;
  std::string content = image(picture);
  Labels labels(width, height);
  std::vector<std::optional<Eigen::Vector2d>> pixels;
  const Eigen::AlignedBox2d page(Eigen::Vector2d::Zero(), Eigen::Vector2d(width, height));
  for (const MapMark& mark : marks) {
    pixels.push_back(pixelOf(drawn.view, mark.p_world));
    if (pixels.back() && !page.contains(*pixels.back())) pixels.back().reset();
    if (pixels.back()) labels.avoid(*pixels.back());
  }
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (pixels[i]) content += markDrawing(marks[i].id, *pixels[i], labels);
  }
  content += scaleBar(drawn.scale, {0.25 * width, height + 10.0, 0.5 * width, 18.0}, kLetters);
  return svg(width, height + 64.0, label, content);
}

std::string spotDrawing(const SpotPicture& drawn, const Hotspot& spot, const std::string& label) {
  const double side = drawn.picture.width_px;
  std::string content = image(drawn.picture) + ellipseDrawing(drawn, spot, 0.5 * side);
  const double length = roundLength(0.4 * drawn.half_width);
  const double px = length / (2.0 * drawn.half_width) * side;
  content += fmt::format(
      "<rect x=\"8\" y=\"{0:.1f}\" width=\"{1:.1f}\" height=\"20\" rx=\"3\" fill=\"#fff\" "
      "fill-opacity=\"0.85\"/><line x1=\"14\" x2=\"{2:.1f}\" y1=\"{3:.1f}\" y2=\"{3:.1f}\" "
      "stroke=\"#16191d\" stroke-width=\"3\"/><text x=\"{4:.1f}\" y=\"{5:.1f}\" "
      "font-size=\"13\">{6:g} cm</text>\n",
      side - 28.0, px + 62.0, 14.0 + px, side - 18.0, 20.0 + px, side - 14.0, 100.0 * length);
  content += scaleBar(drawn.picture.scale, {14.0, side + 8.0, side - 52.0, 11.0}, 14.0);
  return svg(side, side + 42.0, label, content);
}

std::string cropDrawing(const FrameCrop& crop, const std::string& label) {
  constexpr double kScaleHeight = 42.0;
  std::string content = image(crop.width_px, crop.height_px, crop.bytes);
  for (const auto& [colour, width] : {std::pair{"#fff", 4.0}, std::pair{"#0b4f94", 2.0}}) {
    content += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n",
        crop.spot_px.x() + 0.5, crop.spot_px.y() + 0.5, kRing, colour, width);
  }
  const double width = crop.width_px;
  if (crop.scale) content += scaleBar(*crop.scale, {14.0, crop.height_px + 8.0, width - 52.0, 11.0}, 14.0);
  return svg(width, crop.height_px + (crop.scale ? kScaleHeight : 0.0), label, content);
}

}  // namespace thermovox
