#pragma once

#include <span>
#include <vector>

#include "projection/camera.hpp"
#include "projection/occluder.hpp"
#include "projection/pose.hpp"

namespace thermovox {

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

  /// An empty view of a camera that stands at T_camera_world.
  DepthSectors(const Camera& camera, const Pose& T_camera_world, const Options& options);

  [[nodiscard]] const Pose& T_camera_world() const { return T_camera_world_; }

  /// Adds surface points (world, metres). Points outside the image (and a rim of the radius) do nothing.
  void add(std::span<const Eigen::Vector3d> points_world);
  void add(const Eigen::Vector3d& p_world);
  /// To be called after the last add and before the first question.
  void finish();

  [[nodiscard]] bool hides(const Sight& sight) const override {
    return sight.depth > hiddenBeyond(sight.pixel);
  }
  /// Depth (z, metres) beyond which nothing is visible at the pixel; infinity where all is.
  [[nodiscard]] float hiddenBeyond(const Eigen::Vector2d& pixel) const;

 private:
  struct Neighbour {
    std::ptrdiff_t offset;  ///< in nearest_
    std::size_t sector;
    float scale;  ///< depth it hides beyond, as a factor of its own depth
  };
  using Ring = std::vector<Neighbour>;  ///< the neighbours at one distance
  [[nodiscard]] std::vector<Ring> rings() const;
  [[nodiscard]] float depthHiddenBeyond(std::ptrdiff_t bin, const std::vector<Ring>& rings) const;
  [[nodiscard]] std::ptrdiff_t binOf(const Eigen::Vector2d& pixel) const;

  const Camera* camera_;
  Pose T_camera_world_;
  Options options_;
  int columns_ = 0;  ///< bins of the image and its rim
  int rows_ = 0;
  std::vector<float> nearest_;  ///< smallest depth in a bin, infinity where no point fell
  std::vector<float> hidden_beyond_;
};

}  // namespace thermovox
