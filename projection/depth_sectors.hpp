#pragma once

#include <span>
#include <vector>

#include "projection/camera.hpp"
#include "projection/occluder.hpp"
#include "projection/point_block.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// How the pixels of an image fall into bins, with a rim of bins all around.
struct BinGrid {
  double bin_px = 1.0;  ///< edge of a bin
  int rim = 0;
  int columns = 0;  ///< bins across image and rim
  int rows = 0;

  /// Does a bin lie under the pixel's coordinate along a side of so many bins?
  [[nodiscard]] bool covers(double pixel, int bins) const {
    const double bin = (pixel + 0.5) / bin_px;
    return bin >= -rim && bin < bins - rim;
  }
  /// Number of the pixel's bin, row by row; where there is none, or it is NaN, of an outermost one.
  [[nodiscard]] THERMOVOX_INLINE_LOOP int binOf(double u, double v) const {
    return along(v, rows) * columns + along(u, columns);
  }

 private:
  [[nodiscard]] THERMOVOX_INLINE_LOOP int along(double pixel, int bins) const {
    const double bin = (pixel + 0.5) / bin_px;
    const double least = -rim;
    const double most = bins - 1 - rim;
    const double at_least = bin > least ? bin : least;
    const double within = at_least < most ? at_least : most;
    const int truncated = static_cast<int>(within);
    return (within < truncated ? truncated - 1 : truncated) + rim;
  }
};

/// Visibility from one frame, decided by the points that a laser measured around it.
///
/// A one-pixel z-buffer is no occlusion test for sparse points: between the points of a near plate the wall
/// behind shines through. So a pixel asks its neighbourhood, as far as it has to until every one of eight
/// sectors has an answer: the nearest surface in it. A point is hidden when nearer surfaces stand on two
/// opposite sides of it, that is, when it lies inside the silhouette of something and not merely beside it.
/// A surface that slopes towards the camera must not hide itself: a neighbour d pixels away counts only by
/// how much it is nearer than the steepest slope allowed could make it. The idea is the solid-angle test of
/// Pintus, Gobbetti and Agus (2011), here once per pixel so that a query is one comparison.
class DepthSectors final : public Occluder {
 public:
  struct Options {
    double bin_px = 0.0;    ///< edge of a bin; 0 chooses about 160 bins across the image
    int radius_bins = 7;    ///< how far a pixel asks
    int more_bins = 1;      ///< how far it asks on once every sector has an answer
    double slope = 4.0;     ///< steepest surface that must not hide itself: metres nearer per metre aside
    double margin = 0.08;   ///< metres a surface must at least be nearer to hide
    void validate() const;  ///< throws ConfigError naming the field
  };

  /// An empty view of a camera that stands at T_camera_world. What it says is the same at every level.
  DepthSectors(const Camera& camera, const Pose& T_camera_world, const Options& options,
               CpuLevel level = cpuLevel());

  [[nodiscard]] const Pose& T_camera_world() const { return T_camera_world_; }

  /// Adds surface points (world, metres). Points outside the image (and a rim of the radius) do nothing.
  void add(std::span<const Eigen::Vector3d> points_world);
  void add(const Eigen::Vector3d& p_world);
  /// To be called after the last add and before the first question.
  void finish();

  [[nodiscard]] bool hides(const Sight& sight) const override {
    return sight.depth > hiddenBeyond(sight.pixel);
  }
  void hide(const Sights& sights, std::span<std::uint8_t> hidden) const override;
  /// Depth (z, metres) beyond which nothing is visible at the pixel; infinity where all is.
  [[nodiscard]] float hiddenBeyond(const Eigen::Vector2d& pixel) const;

 private:
  void addPending();

  double focal_px_;
  Projector projector_;
  Pose T_camera_world_;
  Options options_;
  CpuLevel level_;
  BinGrid grid_;
  PointBlock pending_;          ///< points that are not in nearest_ yet
  std::vector<float> nearest_;  ///< smallest depth in a bin, infinity where no point fell
  std::vector<float> hidden_beyond_;
};

}  // namespace thermovox
