#include "projection/depth_sectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr int kSectors = 8;
constexpr double kBinsAcross = 160.0;
constexpr float kNothing = std::numeric_limits<float>::infinity();

int sectorOf(int du, int dv) {
  // Half a sector of turn, so that the axes and diagonals lie inside sectors and not on their borders.
  const double turn = std::atan2(dv, du) / (2.0 * std::numbers::pi) * kSectors + 0.5;
  return (static_cast<int>(std::floor(turn)) + kSectors) % kSectors;
}

}  // namespace

void DepthSectors::Options::validate() const {
  if (!(bin_px >= 0.0)) throw ConfigError("bin_px: expected 0 or more px, found " + std::to_string(bin_px));
  if (radius_bins < 1 || radius_bins > 32) {
    throw ConfigError("radius_bins: expected 1 to 32, found " + std::to_string(radius_bins));
  }
  if (more_bins < 0) throw ConfigError("more_bins: expected 0 or more, found " + std::to_string(more_bins));
  if (!(slope >= 0.0 && margin >= 0.0)) throw ConfigError("slope and margin: expected 0 or more");
}

DepthSectors::DepthSectors(const Camera& camera, const Pose& T_camera_world, const Options& options)
    : camera_(&camera), T_camera_world_(T_camera_world), options_(options) {
  options_.validate();
  if (options_.bin_px == 0.0) options_.bin_px = std::max(1.0, std::round(camera.width() / kBinsAcross));
  const auto bins = [&](int pixels) {
    return static_cast<int>(std::ceil(pixels / options_.bin_px)) + 2 * options_.radius_bins;
  };
  columns_ = bins(camera.width());
  rows_ = bins(camera.height());
  nearest_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNothing);
}

std::ptrdiff_t DepthSectors::binOf(const Eigen::Vector2d& pixel) const {
  const int column = static_cast<int>(std::floor((pixel.x() + 0.5) / options_.bin_px)) + options_.radius_bins;
  const int row = static_cast<int>(std::floor((pixel.y() + 0.5) / options_.bin_px)) + options_.radius_bins;
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return -1;
  return static_cast<std::ptrdiff_t>(row) * columns_ + column;
}

void DepthSectors::add(const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p_camera = T_camera_world_ * p_world;
  const auto pixel = camera_->projectUnbounded(p_camera);
  if (!pixel) return;
  const double limit = 1e6;  // keeps the conversion to int defined
  if (!(std::abs(pixel->x()) < limit && std::abs(pixel->y()) < limit)) return;
  const std::ptrdiff_t bin = binOf(*pixel);
  if (bin < 0) return;
  float& nearest = nearest_[static_cast<std::size_t>(bin)];
  nearest = std::min(nearest, static_cast<float>(p_camera.z()));
}

void DepthSectors::add(std::span<const Eigen::Vector3d> points_world) {
  for (const Eigen::Vector3d& p_world : points_world) add(p_world);
}

std::vector<DepthSectors::Ring> DepthSectors::rings() const {
  const double focal_px = std::min(camera_->fx(), camera_->fy());
  const int radius = options_.radius_bins;
  std::vector<Ring> rings(static_cast<std::size_t>(radius));
  for (int dv = -radius; dv <= radius; ++dv) {
    for (int du = -radius; du <= radius; ++du) {
      const double distance = std::hypot(du, dv);
      const int ring = static_cast<int>(std::round(distance));
      if (ring < 1 || ring > radius) continue;
      const double aside = distance * options_.bin_px / focal_px;  // tangent of the angle
      const double scale = 1.0 / std::max(0.05, 1.0 - options_.slope * aside);
      rings[static_cast<std::size_t>(ring - 1)].push_back({static_cast<std::ptrdiff_t>(dv) * columns_ + du,
                                                           static_cast<std::size_t>(sectorOf(du, dv)),
                                                           static_cast<float>(scale)});
    }
  }
  return rings;
}

float DepthSectors::depthHiddenBeyond(std::ptrdiff_t bin, const std::vector<Ring>& rings) const {
  std::array<float, kSectors> sectors;
  sectors.fill(kNothing);
  int more_bins = options_.more_bins;
  for (const Ring& ring : rings) {
    for (const Neighbour& n : ring) {
      const float depth = nearest_[static_cast<std::size_t>(bin + n.offset)] * n.scale;
      sectors[n.sector] = std::min(sectors[n.sector], depth);
    }
    const bool all_answered =
        std::all_of(sectors.begin(), sectors.end(), [](float depth) { return depth < kNothing; });
    if (all_answered && more_bins-- == 0) break;
  }
  // Between two opposite sectors that are both nearer: the farther of the two decides; the best pair counts.
  float hidden_beyond = kNothing;
  for (std::size_t i = 0; i < kSectors / 2; ++i) {
    hidden_beyond = std::min(hidden_beyond, std::max(sectors[i], sectors[i + kSectors / 2]));
  }
  return hidden_beyond + static_cast<float>(options_.margin);
}

void DepthSectors::finish() {
  const std::vector<Ring> around = rings();
  hidden_beyond_.assign(nearest_.size(), kNothing);
  const int rim = options_.radius_bins;
  for (int row = rim; row < rows_ - rim; ++row) {
    for (int column = rim; column < columns_ - rim; ++column) {
      const std::ptrdiff_t bin = static_cast<std::ptrdiff_t>(row) * columns_ + column;
      hidden_beyond_[static_cast<std::size_t>(bin)] = depthHiddenBeyond(bin, around);
    }
  }
}

float DepthSectors::hiddenBeyond(const Eigen::Vector2d& pixel) const {
  const std::ptrdiff_t bin = binOf(pixel);
  return bin < 0 ? kNothing : hidden_beyond_[static_cast<std::size_t>(bin)];
}

}  // namespace thermovox
