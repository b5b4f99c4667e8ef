#pragma once

#include <cstdint>
#include <vector>

#include "apps/simulate/board_render.hpp"
#include "apps/simulate/capture_scene.hpp"

namespace thermovox::simulate {

/// What the two cameras of a scene see of its captures. The board is heated and hottest near its middle; its
/// dark squares have another emissivity than the rest and look colder. Before it and behind it all is of one
/// temperature and one grey.
class CaptureRenderer {
 public:
  /// Keeps a ray for every pixel. The scene has to outlive the renderer.
  explicit CaptureRenderer(const CaptureScene& scene);

  /// Counts of the thermal camera's TIFF, row by row, with the NETD's noise.
  [[nodiscard]] std::vector<std::uint16_t> thermalCounts(std::size_t capture) const;
  /// Brightness of the visible picture, row by row, with noise.
  [[nodiscard]] std::vector<std::uint8_t> luminance(std::size_t capture) const;

 private:
  const CaptureScene& scene_;
  BoardRenderer thermal_;
  BoardRenderer visible_;
};

}  // namespace thermovox::simulate
