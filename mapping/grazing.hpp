#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "mapping/frame_window.hpp"
#include "projection/placement.hpp"

namespace thermovox {

/// What a temperature is worth, for the angle at which its surface was seen.
struct GrazingView {
  float incidence = std::numeric_limits<float>::quiet_NaN();  ///< from the normal, radians; NaN unknown
  float sigma = 0.0F;  ///< of what emissivityLoss() takes from the temperature, C; 0 where unknown
};

struct SeenSurface {
  Eigen::Vector3d p_world;  ///< metres
  float celsius;            ///< as it was seen
};

/// Of a surface with that unit normal (zero: unknown). Seen at an angle it lacks a share of its own radiation
/// and mirrors as much of its surroundings (`reflected`, C), so that its temperature errs by that share of
/// its difference to them. How much of that is true depends on how smooth it is: hence it is taken as a
/// sigma.
[[nodiscard]] GrazingView grazingView(const Eigen::Vector3f& normal, const SeenSurface& seen,
                                      const ThermalView& view, double reflected);

/// What the surroundings of a frame's objects have for a temperature, C: as the frame's radiometry says, else
/// the mission's air, else what cameras assume.
[[nodiscard]] double reflectedTemperature(const ThermalImage& image, const std::optional<double>& ambient);

/// The normals of a reading's coloured points, from one another: points that lie in one cube of `edge` metres
/// and make a plane share its normal; zero for all others, where the cube holds fewer than eight points, and
/// where the plane is as narrow as the noise (three times `range_sigma`). The points of one line of a scanner
/// lie in a plane, too, which is no surface: it holds the laser. So a plane that the laser would have seen at
/// more than 78 degrees is none.
[[nodiscard]] std::vector<Eigen::Vector3f> readingNormals(std::span<const PlacedReturn> returns,
                                                          std::span<const std::optional<FrameColour>> found,
                                                          double edge, double range_sigma);

/// What the mapper knows beside a reading.
struct GrazingOptions {
  double edge;                    ///< of the cubes of readingNormals, metres
  double range_sigma;             ///< metres
  std::optional<double> ambient;  ///< of the mission, C
};

/// Puts what grazing views are worth into the sigmas of a reading's colours. Returns their incidences.
[[nodiscard]] std::vector<float> distrustGrazing(std::span<const PlacedReturn> returns,
                                                 std::span<std::optional<FrameColour>> found,
                                                 const GrazingOptions& options);

}  // namespace thermovox
