#include "io/splat_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace thermovox {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// The picture while it is drawn: depth (metres, infinite where nothing is) and lit colour of every pixel.
struct Canvas {
  int width = 0;
  int height = 0;
  std::vector<float> depth;
  std::vector<Rgb> colour;

  [[nodiscard]] std::size_t at(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
  }
};

Rgb scaled(const Rgb& colour, double factor) {
  const auto channel = [factor](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(value * factor), 0L, 255L));
  };
  return {channel(colour.r), channel(colour.g), channel(colour.b)};
}

/// Lambert's cosine over an ambient part; a splat without normal is lit half.
double brightness(const Eigen::Vector3d& normal_view) {
  const Eigen::Vector3d light = Eigen::Vector3d(-0.45, -0.75, -0.5).normalized();
  const double cosine = normal_view.isZero() ? 0.5 : std::max(0.0, normal_view.dot(light));
  return 0.70 + 0.34 * cosine;
}

/// One disc in the frame of the view, its normal towards the viewer.
struct Disc {
  Eigen::Vector3d center;
  Eigen::Vector3d normal;
  double radius = 0.0;
  Rgb colour;

  /// Depth at which the ray (x, y, 1) meets the disc; infinite when it passes by.
  [[nodiscard]] double depthAlong(const Eigen::Vector3d& ray) const {
    const double slope = normal.dot(ray);
    if (std::abs(slope) < 1e-9) return kNothing;
    const double depth = normal.dot(center) / slope;
    return (depth * ray - center).squaredNorm() <= radius * radius ? depth : kNothing;
  }
};

void drawDisc(const Disc& disc, const PictureView& view, Canvas& canvas) {
  const double scale = view.focal_px / disc.center.z();
  const double u = view.center_x_px + scale * disc.center.x();
  const double v = view.center_y_px + scale * disc.center.y();
  const double reach = std::max(disc.radius * scale * 1.1, 0.71);
  const int first_u = std::max(0, static_cast<int>(std::ceil(u - reach)));
  const int last_u = std::min(canvas.width - 1, static_cast<int>(std::floor(u + reach)));
  const int first_v = std::max(0, static_cast<int>(std::ceil(v - reach)));
  const int last_v = std::min(canvas.height - 1, static_cast<int>(std::floor(v + reach)));
  for (int y = first_v; y <= last_v; ++y) {
    for (int x = first_u; x <= last_u; ++x) {
      const Eigen::Vector3d ray((x - view.center_x_px) / view.focal_px,
                                (y - view.center_y_px) / view.focal_px, 1.0);
      // A disc smaller than a pixel still shows.
      const double met = reach < 1.0 ? disc.center.z() : disc.depthAlong(ray);
      const std::size_t i = canvas.at(x, y);
      if (!(met < canvas.depth[i])) continue;
      canvas.depth[i] = static_cast<float>(met);
      canvas.colour[i] = disc.colour;
    }
  }
}

Disc discOf(const Splat& splat, const Pose& T_view_world) {
  Disc disc{T_view_world * splat.p_world.cast<double>(),
            T_view_world.rotation * splat.normal.cast<double>(),
            splat.radius,
            {}};
  const Eigen::Vector3d towards_viewer = -disc.center.normalized();
  if (disc.normal.dot(towards_viewer) < 0.0) disc.normal = -disc.normal;
  disc.colour = scaled(splat.colour, brightness(disc.normal));
  // Nearly edge-on a disc would vanish; so it faces the viewer, as one of unknown normal does.
  if (disc.normal.dot(towards_viewer) < 0.2) disc.normal = towards_viewer;
  return disc;
}

/// How much of its light a pixel keeps: neighbours that are nearer, in octaves of depth, shade it.
double eyeDome(const Canvas& canvas, int u, int v) {
  constexpr std::array<std::array<int, 2>, 8> kAround{
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
  constexpr double kStrength = 9.0;
  constexpr double kDeepest = 0.06;  // one step shades no more than this many octaves
  const double depth = std::log2(canvas.depth[canvas.at(u, v)]);
  double shade = 0.0;
  for (const int distance : {2, 5}) {
    for (const auto& [du, dv] : kAround) {
      const int x = u + du * distance;
      const int y = v + dv * distance;
      if (x < 0 || y < 0 || x >= canvas.width || y >= canvas.height) continue;
      const float other = canvas.depth[canvas.at(x, y)];
      if (other == kNothing) continue;
      shade += std::clamp(depth - std::log2(other) - 0.004, 0.0, kDeepest);
    }
  }
  return std::exp(-kStrength * shade / 4.0);
}

}  // namespace

RgbPicture drawSplats(std::span<const Splat> splats, const PictureView& view, const RgbPicture& background) {
  Canvas canvas{view.width_px, view.height_px, {}, {}};
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  canvas.depth.assign(pixels, kNothing);
  canvas.colour.resize(pixels);
  const Pose T_view_world = view.T_world_view.inverse();
  for (const Splat& splat : splats) {
    const Disc disc = discOf(splat, T_view_world);
    if (disc.center.z() > 2.0 * disc.radius) drawDisc(disc, view, canvas);
  }
  RgbPicture picture = background;
  for (int v = 0; v < canvas.height; ++v) {
    for (int u = 0; u < canvas.width; ++u) {
      const std::size_t i = canvas.at(u, v);
      if (canvas.depth[i] == kNothing) continue;
      const Rgb colour = scaled(canvas.colour[i], eyeDome(canvas, u, v));
      picture.rgb[3 * i] = colour.r;
      picture.rgb[3 * i + 1] = colour.g;
      picture.rgb[3 * i + 2] = colour.b;
    }
  }
  return picture;
}

}  // namespace thermovox
