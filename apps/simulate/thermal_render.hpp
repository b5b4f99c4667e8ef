#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "apps/simulate/simulation.hpp"
#include "projection/radiometry.hpp"

namespace thermovox::simulate {

/// Renders what the thermal camera sees: rays through the exact lens model, several a pixel, averaged over
/// the pixel and blurred by a Gaussian so that optics and pixel together have the camera's blur_px. All
/// surfaces are black; the frame is taken in an instant. Of radiometric frames every ray passes the air of
/// its own length.
class ThermalRenderer {
 public:
  /// Keeps the rays of every sample. The simulation must outlive the renderer.
  explicit ThermalRenderer(const Simulation& simulation);

  /// Celsius without noise, row by row, of radiometric frames as one decodes them with distance 0; NaN where
  /// the lens has no ray.
  [[nodiscard]] std::vector<float> render(const Pose& T_world_body) const;
  /// Counts of the frame with the NETD's noise and the camera's bias, row by row; 0 where the lens has no
  /// ray.
  [[nodiscard]] std::vector<std::uint16_t> counts(std::size_t frame) const;

 private:
  [[nodiscard]] std::vector<float> sampleRays(const Pose& T_world_body) const;
  [[nodiscard]] std::vector<float> blurAlong(const std::vector<float>& samples, std::size_t stride) const;

  [[nodiscard]] double countOf(double celsius) const;

  const Simulation& simulation_;
  std::optional<RadiometricParameters> radiometry_;  ///< of radiometric frames, with distance 0
  int samples_ = 1;                                  ///< a pixel and axis
  int columns_ = 0;                                  ///< of the sampled image, margin included
  int rows_ = 0;
  std::vector<double> kernel_;                ///< of the optics, in samples, its middle at size / 2
  std::vector<Eigen::Vector3f> rays_camera_;  ///< unit; zero where the lens has no ray
};

}  // namespace thermovox::simulate
