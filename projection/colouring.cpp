#include "projection/colouring.hpp"

#include <cmath>

namespace thermovox {
namespace {

/// See pixelVariance in projector.hpp.
float pixelVariance(const Projector& projector, const Coordinates3& p_camera,
                    const PackedCovariance& covariance) {
  const auto x = static_cast<float>(p_camera.x / p_camera.z);
  const auto y = static_cast<float>(p_camera.y / p_camera.z);
  const auto inverse_depth = static_cast<float>(1.0 / p_camera.z);
  return withLensModel(projector.lens.model, [&](auto model) {
    return pixelVariance<model.value>(ErrorProjector(projector), x, y, inverse_depth, covariance.entries);
  });
}

}  // namespace

std::variant<Colour, NoColour> colour(const PlacedReturn& point, const ThermalView& view,
                                      const ThermalCamera& camera, const Occluder& occluder) {
  const Coordinates3 p =
      transformed(view.projector.T_camera_world, point.p_world.x(), point.p_world.y(), point.p_world.z());
  const std::optional<Eigen::Vector2d> pixel = camera.camera.project({p.x, p.y, p.z});
  if (!pixel) return NoColour::outside_image;
  if (occluder.hides({view.T_world_camera.translation, point.p_world, *pixel, p.z})) return NoColour::hidden;
  const std::optional<TemperatureSample> sample = sampleTemperature(*view.frame.image, *pixel, view.noise);
  if (!sample) return NoColour::unknown_pixel;

  const float variance_px2 = pixelVariance(view.projector, p, point.rig_covariance);
  const float local_variance = view.local_variance.at(*pixel, variance_px2);
  const float sigma = std::sqrt(sample->noise_sigma * sample->noise_sigma + local_variance);
  const auto range = static_cast<float>(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
  const AirPath* const air = view.frame.image->air.get();
  if (air == nullptr) return Colour{view.frame.stamp, *pixel, sample->celsius, sigma, range};
  const AirPath::Corrected corrected = air->at(sample->celsius, range);
  if (std::isnan(corrected.celsius)) return NoColour::unknown_pixel;
  return Colour{view.frame.stamp, *pixel, static_cast<float>(corrected.celsius),
                sigma * static_cast<float>(corrected.slope), range};
}

}  // namespace thermovox
