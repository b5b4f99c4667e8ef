#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "projection/colouring.hpp"
#include "projection/cpu_level.hpp"

namespace thermovox {

struct ColouringBlock;

/// What a frame says to a point; the numbers of Colour, and only where there is one.
struct PointColour {
  enum class Outcome : std::uint8_t { coloured, outside_image, hidden, unknown_pixel };
  double u = 0.0, v = 0.0;  ///< where the point projects, px
  float celsius = 0.0F;
  float sigma = 0.0F;
  float range = 0.0F;
  Outcome outcome = Outcome::outside_image;

  /// As colour() says it.
  [[nodiscard]] std::variant<Colour, NoColour> by(Time frame_stamp) const;
};

/// A frame that colours, and what hides things from it.
struct SeeingFrame {
  const ThermalView& view;
  const ThermalCamera& camera;
  const Occluder& occluder;
};

/// colour() for many points at a time, to the bit as colour() says it at every level. The points go through
/// in blocks whose columns stay in the nearest cache: one loop projects them all, those in the image are
/// asked for and sampled. A batch keeps its memory from call to call.
class ColouringBatch {
 public:
  explicit ColouringBatch(CpuLevel level = cpuLevel());
  ~ColouringBatch();
  ColouringBatch(ColouringBatch&&) noexcept;
  ColouringBatch& operator=(ColouringBatch&&) noexcept;

  /// What the frame says to each of the points, in their order; valid until the next call.
  [[nodiscard]] std::span<const PointColour> colour(std::span<const PlacedReturn> points,
                                                    const SeeingFrame& frame);
  /// The same for those of the points whose numbers `which` lists.
  [[nodiscard]] std::span<const PointColour> colour(std::span<const PlacedReturn> points,
                                                    std::span<const std::uint32_t> which,
                                                    const SeeingFrame& frame);
  /// The bilinear temperatures alone, as they stand in the image: without visibility, errors and air. NaN
  /// where the frame has none.
  [[nodiscard]] std::span<const float> sample(std::span<const Eigen::Vector3d> points_world,
                                              const ThermalView& view);

 private:
  template <typename PointAt>
  [[nodiscard]] std::span<const PointColour> colourEach(std::size_t count, const SeeingFrame& frame,
                                                        const PointAt& point_at);

  CpuLevel level_;
  std::unique_ptr<ColouringBlock> block_;
  std::vector<PointColour> colours_;
  std::vector<float> celsius_;
};

}  // namespace thermovox
