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

constexpr std::size_t kSectors = 8;
constexpr double kBinsAcross = 160.0;
constexpr float kNothing = std::numeric_limits<float>::infinity();

std::size_t sectorOf(int du, int dv) {
  // Half a sector of turn, so that the axes and diagonals lie inside sectors and not on their borders.
  const double turn = std::atan2(dv, du) / (2.0 * std::numbers::pi) * kSectors + 0.5;
  return static_cast<std::size_t>(static_cast<int>(std::floor(turn)) + static_cast<int>(kSectors)) % kSectors;
}

struct Neighbour {
  std::ptrdiff_t offset;  ///< in the plane of bins
  float scale;            ///< depth it hides beyond, as a factor of its own depth
};
/// The neighbours at one distance, by sector.
using Ring = std::array<std::vector<Neighbour>, kSectors>;

std::vector<Ring> ringsAround(const DepthSectors::Options& options, double focal_px, int columns) {
  const int radius = options.radius_bins;
  std::vector<Ring> rings(static_cast<std::size_t>(radius));
  for (int dv = -radius; dv <= radius; ++dv) {
    for (int du = -radius; du <= radius; ++du) {
      const double distance = std::sqrt(static_cast<double>(du * du + dv * dv));
      const int ring = static_cast<int>(std::round(distance));
      if (ring < 1 || ring > radius) continue;
      const double aside = distance * options.bin_px / focal_px;  // tangent of the angle
      const double scale = 1.0 / std::max(0.05, 1.0 - options.slope * aside);
      rings[static_cast<std::size_t>(ring - 1)][sectorOf(du, dv)].push_back(
          {static_cast<std::ptrdiff_t>(dv) * columns + du, static_cast<float>(scale)});
    }
  }
  return rings;
}

/// One row of bins on its way to an answer; each column is as long as the image has bins.
struct Row {
  std::size_t size;
  std::array<std::vector<float>, kSectors> sectors;  ///< nearest depth in each sector so far
  std::vector<float> nearest;                        ///< of one sector in the ring at hand
  std::vector<std::int32_t> more_bins;               ///< how far each asks on; negative when it is done

  explicit Row(std::size_t bins) : size(bins), nearest(bins), more_bins(bins) {
    for (std::vector<float>& sector : sectors) sector.resize(bins);
  }
};

/// Starts a row whose bins ask on by `more_bins`.
void begin(Row& row, int more_bins) {
  for (std::vector<float>& sector : row.sectors) std::fill(sector.begin(), sector.end(), kNothing);
  std::fill(row.more_bins.begin(), row.more_bins.end(), more_bins);
}

/// Nearest depth among the neighbours in one sector of a ring.
THERMOVOX_INLINE_LOOP void askSector(Row& row, const std::vector<Neighbour>& neighbours, const float* bins) {
  const std::size_t n = row.size;
  float* const __restrict nearest = row.nearest.data();
  for (std::size_t u = 0; u < n; ++u) nearest[u] = kNothing;
  for (const Neighbour& neighbour : neighbours) {
    const float* const depths = bins + neighbour.offset;
    const float scale = neighbour.scale;
    for (std::size_t u = 0; u < n; ++u) {
      const float depth = depths[u] * scale;
      nearest[u] = depth < nearest[u] ? depth : nearest[u];
    }
  }
}

/// Asks the neighbours at one distance; returns how many bins of the row ask on.
THERMOVOX_INLINE_LOOP int askRing(Row& row, const Ring& ring, const float* bins) {
  const std::size_t n = row.size;
  std::int32_t* const __restrict more_bins = row.more_bins.data();
  float* const __restrict nearest = row.nearest.data();
  for (std::size_t s = 0; s < kSectors; ++s) {
    askSector(row, ring[s], bins);
    float* const __restrict sector = row.sectors[s].data();
    for (std::size_t u = 0; u < n; ++u) {
      const float nearer = nearest[u] < sector[u] ? nearest[u] : sector[u];
      sector[u] = more_bins[u] >= 0 ? nearer : sector[u];
    }
  }
  float* const __restrict farthest = nearest;
  for (std::size_t u = 0; u < n; ++u) farthest[u] = 0.0F;
  for (const std::vector<float>& sector : row.sectors) {
    const float* const __restrict depths = sector.data();
    for (std::size_t u = 0; u < n; ++u) farthest[u] = depths[u] > farthest[u] ? depths[u] : farthest[u];
  }
  // Once every sector has an answer, the rings that are still to be asked count down.
  std::int32_t asking = 0;
  for (std::size_t u = 0; u < n; ++u) {
    more_bins[u] -= farthest[u] < kNothing ? 1 : 0;
    asking += more_bins[u] >= 0 ? 1 : 0;
  }
  return asking;
}

/// Between two opposite sectors that are both nearer: the farther of the two decides; the best pair counts.
THERMOVOX_INLINE_LOOP void decide(const Row& row, float margin, float* __restrict hidden_beyond) {
  for (std::size_t u = 0; u < row.size; ++u) hidden_beyond[u] = kNothing;
  for (std::size_t i = 0; i < kSectors / 2; ++i) {
    const float* const a = row.sectors[i].data();
    const float* const b = row.sectors[i + kSectors / 2].data();
    for (std::size_t u = 0; u < row.size; ++u) {
      const float farther = a[u] < b[u] ? b[u] : a[u];
      hidden_beyond[u] = farther < hidden_beyond[u] ? farther : hidden_beyond[u];
    }
  }
  for (std::size_t u = 0; u < row.size; ++u) hidden_beyond[u] += margin;
}

THERMOVOX_INLINE_LOOP void finishRow(Row& row, const std::vector<Ring>& rings, const float* bins,
                                     float margin, float* hidden_beyond) {
  for (const Ring& ring : rings) {
    if (askRing(row, ring, bins) == 0) break;
  }
  decide(row, margin, hidden_beyond);
}
using FinishRow = void (*)(Row&, const std::vector<Ring>&, const float*, float, float*);
void finishRowBaseline(Row& row, const std::vector<Ring>& rings, const float* bins, float margin,
                       float* hidden_beyond) {
  finishRow(row, rings, bins, margin, hidden_beyond);
}
THERMOVOX_TARGET_AVX2 void finishRowAvx2(Row& row, const std::vector<Ring>& rings, const float* bins,
                                         float margin, float* hidden_beyond) {
  finishRow(row, rings, bins, margin, hidden_beyond);
}
THERMOVOX_TARGET_AVX512 void finishRowAvx512(Row& row, const std::vector<Ring>& rings, const float* bins,
                                             float margin, float* hidden_beyond) {
  finishRow(row, rings, bins, margin, hidden_beyond);
}

/// The bins first, then what they say.
THERMOVOX_INLINE_LOOP void findHidden(const BinGrid& of, const float* hidden_beyond, const Sights& sights,
                                      std::uint8_t* hidden) {
  const BinGrid grid = of;
  std::array<std::int32_t, kBlockPoints> bins;
  for (std::size_t begin = 0; begin < sights.size(); begin += kBlockPoints) {
    const std::size_t n = std::min(kBlockPoints, sights.size() - begin);
    const double* const u = sights.u.data() + begin;
    const double* const v = sights.v.data() + begin;
    for (std::size_t i = 0; i < n; ++i) bins[i] = grid.binOf(u[i], v[i]);
    for (std::size_t i = 0; i < n; ++i)
      hidden[begin + i] = sights.depth[begin + i] > hidden_beyond[bins[i]] ? 1 : 0;
  }
}
using FindHidden = void (*)(const BinGrid&, const float*, const Sights&, std::uint8_t*);
void findHiddenBaseline(const BinGrid& grid, const float* hidden_beyond, const Sights& sights,
                        std::uint8_t* hidden) {
  findHidden(grid, hidden_beyond, sights, hidden);
}
THERMOVOX_TARGET_AVX2 void findHiddenAvx2(const BinGrid& grid, const float* hidden_beyond,
                                          const Sights& sights, std::uint8_t* hidden) {
  findHidden(grid, hidden_beyond, sights, hidden);
}
THERMOVOX_TARGET_AVX512 void findHiddenAvx512(const BinGrid& grid, const float* hidden_beyond,
                                              const Sights& sights, std::uint8_t* hidden) {
  findHidden(grid, hidden_beyond, sights, hidden);
}

template <LensModel kModel>
void projectBaseline(const Projector& projector, PointBlock& block) {
  projectBlock<kModel, Field::lens>(projector, block);
}
template <LensModel kModel>
THERMOVOX_TARGET_AVX2 void projectAvx2(const Projector& projector, PointBlock& block) {
  projectBlock<kModel, Field::lens>(projector, block);
}
template <LensModel kModel>
THERMOVOX_TARGET_AVX512 void projectAvx512(const Projector& projector, PointBlock& block) {
  projectBlock<kModel, Field::lens>(projector, block);
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

DepthSectors::DepthSectors(const Camera& camera, const Pose& T_camera_world, const Options& options,
                           CpuLevel level)
    : focal_px_(std::min(camera.fx(), camera.fy())),
      projector_{camera.numbers(), RigidNumbers(T_camera_world)},
      T_camera_world_(T_camera_world),
      options_(options),
      level_(level) {
  options_.validate();
  if (options_.bin_px == 0.0) options_.bin_px = std::max(1.0, std::round(camera.width() / kBinsAcross));
  const auto bins = [&](int pixels) {
    return static_cast<int>(std::ceil(pixels / options_.bin_px)) + 2 * options_.radius_bins;
  };
  grid_ = {options_.bin_px, options_.radius_bins, bins(camera.width()), bins(camera.height())};
  nearest_.assign(static_cast<std::size_t>(grid_.columns) * static_cast<std::size_t>(grid_.rows), kNothing);
}

void DepthSectors::add(const Eigen::Vector3d& p_world) {
  pending_.set(pending_.size++, p_world);
  if (pending_.size == kBlockPoints) addPending();
}

void DepthSectors::add(std::span<const Eigen::Vector3d> points_world) {
  for (const Eigen::Vector3d& p_world : points_world) add(p_world);
}

void DepthSectors::addPending() {
  withLensModel(projector_.lens.model, [&](auto model) {
    if (level_ == CpuLevel::avx512) return projectAvx512<model.value>(projector_, pending_);
    if (level_ == CpuLevel::avx2) return projectAvx2<model.value>(projector_, pending_);
    projectBaseline<model.value>(projector_, pending_);
  });
  for (std::size_t i = 0; i < pending_.size; ++i) {
    const double u = pending_.u[i], v = pending_.v[i];
    if (!(grid_.covers(u, grid_.columns) && grid_.covers(v, grid_.rows))) continue;  // NaN: no pixel
    float& nearest = nearest_[static_cast<std::size_t>(grid_.binOf(u, v))];
    nearest = std::min(nearest, static_cast<float>(pending_.depth[i]));
  }
  pending_.size = 0;
}

void DepthSectors::finish() {
  addPending();
  const std::vector<Ring> rings = ringsAround(options_, focal_px_, grid_.columns);
  const FinishRow finish_row = level_ == CpuLevel::avx512 ? finishRowAvx512
                               : level_ == CpuLevel::avx2 ? finishRowAvx2
                                                          : finishRowBaseline;
  Row row(static_cast<std::size_t>(grid_.columns - 2 * grid_.rim));
  hidden_beyond_.assign(nearest_.size(), kNothing);
  for (int v = grid_.rim; v < grid_.rows - grid_.rim; ++v) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(v) * grid_.columns + grid_.rim;
    begin(row, options_.more_bins);
    finish_row(row, rings, nearest_.data() + first, static_cast<float>(options_.margin),
               hidden_beyond_.data() + first);
  }
}

void DepthSectors::hide(const Sights& sights, std::span<std::uint8_t> hidden) const {
  const FindHidden find_hidden = sights.level == CpuLevel::avx512 ? findHiddenAvx512
                                 : sights.level == CpuLevel::avx2 ? findHiddenAvx2
                                                                  : findHiddenBaseline;
  find_hidden(grid_, hidden_beyond_.data(), sights, hidden.data());
}

float DepthSectors::hiddenBeyond(const Eigen::Vector2d& pixel) const {
  return hidden_beyond_[static_cast<std::size_t>(grid_.binOf(pixel.x(), pixel.y()))];
}

}  // namespace thermovox
