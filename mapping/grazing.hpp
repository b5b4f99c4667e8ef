#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "mapping/frame_window.hpp"
#include "mapping/scene_surfaces.hpp"
#include "projection/placement.hpp"

namespace thermovox {

/// What a temperature is worth, for the angle at which its surface was seen.
struct GrazingView {
  float incidence = std::numeric_limits<float>::quiet_NaN();  ///< from the normal, radians; NaN unknown
  /// Of what emissivityLoss() takes from the temperature, C; 0 where unknown. An error that all views at that
  /// angle have in common, and no noise: TemperatureObservation::common_sigma.
  float sigma = 0.0F;
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

/// The colour with all in its sigma that a single temperature of that view may be off by.
[[nodiscard]] Colour distrusted(Colour colour, const GrazingView& grazing);

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

/// The surface's normal; zero also where its plane is narrow as in readingNormals: neighbours that lie along
/// one line of a scanner make a plane of that line and their noise.
[[nodiscard]] Eigen::Vector3f trustedNormal(const SceneSurface& surface, double range_sigma);

/// The normals of a reading's coloured points in a scene whose geometry is known, for any laser:
/// trustedNormal of the surface in the cell of each; zero for all others.
[[nodiscard]] std::vector<Eigen::Vector3f> sceneNormals(std::span<const PlacedReturn> returns,
                                                        std::span<const std::optional<FrameColour>> found,
                                                        SceneSurfaces& scene, double range_sigma);

/// The views of a reading's points, by their normals; unknown for those without colour. `ambient` is the
/// mission's, C.
[[nodiscard]] std::vector<GrazingView> grazingViews(std::span<const PlacedReturn> returns,
                                                    std::span<const std::optional<FrameColour>> found,
                                                    std::span<const Eigen::Vector3f> normals,
                                                    const std::optional<double>& ambient);

}  // namespace thermovox
