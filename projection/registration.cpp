#include "projection/registration.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace thermovox {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// For every pixel of an image the seed that is nearest to it, passed on from neighbour to neighbour.
class NearestSeeds {
 public:
  NearestSeeds(int width, int height) : width_(width), height_(height), seeds_(size()) {}

  void plant(int u, int v) { seeds_[index(u, v)] = {u, v, true}; }

  void spread() {
    for (int v = 0; v < height_; ++v) {
      for (int u = 0; u < width_; ++u) takeFrom(u, v, {{{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}});
      for (int u = width_ - 1; u >= 0; --u) takeFrom(u, v, {{{1, 0}}});
    }
    for (int v = height_ - 1; v >= 0; --v) {
      for (int u = width_ - 1; u >= 0; --u) takeFrom(u, v, {{{1, 0}, {1, 1}, {0, 1}, {-1, 1}}});
      for (int u = 0; u < width_; ++u) takeFrom(u, v, {{{-1, 0}}});
    }
  }

  /// Index of the seed nearest to a pixel; nullopt when there is no seed at all.
  [[nodiscard]] std::optional<std::size_t> nearest(std::size_t pixel) const {
    const Seed& seed = seeds_[pixel];
    return seed.known ? std::optional(index(seed.u, seed.v)) : std::nullopt;
  }
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
  }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }

 private:
  struct Seed {
    int u = 0, v = 0;
    bool known = false;
  };

  [[nodiscard]] long distance(const Seed& seed, int u, int v) const {
    if (!seed.known) return std::numeric_limits<long>::max();
    const long du = seed.u - u, dv = seed.v - v;
    return du * du + dv * dv;
  }

  void takeFrom(int u, int v, const std::array<std::array<int, 2>, 4>& neighbours) {
    Seed& here = seeds_[index(u, v)];
    for (const auto& [du, dv] : neighbours) {
      if (u + du < 0 || u + du >= width_ || v + dv < 0 || v + dv >= height_) continue;
      const Seed& there = seeds_[index(u + du, v + dv)];
      if (distance(there, u, v) < distance(here, u, v)) here = there;
    }
  }

  int width_;
  int height_;
  std::vector<Seed> seeds_;
};

/// The pixel that covers a place in the image; nullopt outside, also for NaN.
std::optional<std::array<int, 2>> pixelUnder(const Eigen::Vector2d& place, int width, int height) {
  if (!(place.x() >= -0.5 && place.x() < width - 0.5 && place.y() >= -0.5 && place.y() < height - 0.5))
    return std::nullopt;
  return std::array{static_cast<int>(std::floor(place.x() + 0.5)),
                    static_cast<int>(std::floor(place.y() + 0.5))};
}

}  // namespace

std::optional<Eigen::Vector2d> pixelAcross(const CameraPair& pair, const Eigen::Vector2d& pixel,
                                           double depth) {
  if (!(depth > 0.0 && std::isfinite(depth))) return std::nullopt;
  const auto ray = pair.from.rayFromPixel(pixel);
  if (!ray) return std::nullopt;
  return pair.to.projectUnbounded(pair.T_to_from * (depth * *ray));
}

Eigen::Vector2d PixelMap::at(const Eigen::Vector2d& pixel) const {
  const int u = std::clamp(static_cast<int>(std::floor(pixel.x())), 0, width - 2);
  const int v = std::clamp(static_cast<int>(std::floor(pixel.y())), 0, height - 2);
  const double right = pixel.x() - u;
  const double down = pixel.y() - v;
  const auto row = static_cast<std::size_t>(width);
  const auto first = static_cast<std::size_t>(v) * row + static_cast<std::size_t>(u);
  return (1.0 - down) * ((1.0 - right) * pixels[first] + right * pixels[first + 1]) +
         down * ((1.0 - right) * pixels[first + row] + right * pixels[first + row + 1]);
}

PixelMap registerPixels(const CameraPair& pair, std::span<const double> depths) {
  PixelMap map{.width = pair.from.width(), .height = pair.from.height()};
  const auto size = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  assert(depths.size() == 1 || depths.size() == size);
  map.pixels.reserve(size);
  for (int v = 0; v < map.height; ++v) {
    for (int u = 0; u < map.width; ++u) {
      const double depth = depths[depths.size() == 1 ? 0 : map.pixels.size()];
      map.pixels.push_back(
          pixelAcross(pair, Eigen::Vector2d(u, v), depth).value_or(Eigen::Vector2d(kNaN, kNaN)));
    }
  }
  return map;
}

std::vector<double> nearestDepths(int width_px, int height_px, std::span<const PixelDepth> points) {
  NearestSeeds seeds(width_px, height_px);
  std::vector<double> depths(seeds.size(), kNaN);
  for (const PixelDepth& point : points) {
    const auto pixel = pixelUnder(point.pixel, width_px, height_px);
    if (!pixel || !(point.depth > 0.0)) continue;
    const auto& [u, v] = *pixel;
    double& depth = depths[seeds.index(u, v)];
    if (std::isnan(depth) || point.depth < depth) depth = point.depth;
    seeds.plant(u, v);
  }
  seeds.spread();
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (const auto seed = seeds.nearest(i)) depths[i] = depths[*seed];
  }
  return depths;
}

}  // namespace thermovox
