#include "io/picture_registration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/rig_file.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// The picture, unless no pixel of the thermal image lies in it.
RegisteredPicture overlapping(RegisteredPicture registered, const std::string& name) {
  const VisiblePicture& picture = registered.picture;
  const bool overlap = std::any_of(registered.pixels.pixels.begin(), registered.pixels.pixels.end(),
                                   [&](const Eigen::Vector2d& pixel) {
                                     return pixel.x() >= 0.0 && pixel.y() >= 0.0 &&
                                            pixel.x() <= picture.width - 1 && pixel.y() <= picture.height - 1;
                                   });
  if (overlap) return registered;
  throw DataError(name +
                  ": no pixel of it lies in the visible picture, expected cameras that look the same way");
}

}  // namespace

RegisteredPicture registerByRig(const PictureByRig& by, const RawThermalImage& thermal,
                                const std::string& name) {
  const Rig rig = readRig(by.rig);
  if (!rig.thermal_camera || !rig.visible_camera) {
    throw ConfigError(fmt::format("{}: has no {}_camera, expected a rig with both cameras for {}",
                                  by.rig.string(), rig.thermal_camera ? "visible" : "thermal",
                                  by.visible.string()));
  }
  const Camera& camera = rig.thermal_camera->camera;
  if (thermal.width != camera.width() || thermal.height != camera.height()) {
    throw DataError(fmt::format("{}: is {} x {} pixels, expected {} x {} as the rig's thermal camera", name,
                                thermal.width, thermal.height, camera.width(), camera.height()));
  }
  const Pose T_visible_thermal =
      rig.visible_camera->T_body_camera.inverse() * rig.thermal_camera->T_body_camera;
  return overlapping(
      {readVisiblePicture(by.visible, {}, rig.visible_camera->camera),
       registerPixels({camera, rig.visible_camera->camera, T_visible_thermal}, std::array{by.range})},
      name);
}

RegisteredPicture registerByRecord(const RawThermalImage& thermal, const std::string& name) {
  const std::optional<EmbeddedPicture>& visible = thermal.metadata.visible;
  const std::optional<PictureInPicture>& record = thermal.metadata.picture_in_picture;
  if (!visible || !record) {
    throw DataError(fmt::format("{}: holds no {}, expected a FLIR file with both to draw edges by", name,
                                visible ? "record of where its visible picture lies" : "visible picture"));
  }
  if (!(std::isfinite(record->real_to_ir) && record->real_to_ir > 0.0)) {
    throw DataError(fmt::format("{}: says Real2IR {}, expected a positive number", name, record->real_to_ir));
  }
  RegisteredPicture registered{decodeVisiblePicture(*visible, name + ": its visible picture"), {}};
  registered.pixels = pixelsByRecord(*record, thermal, registered.picture);
  return overlapping(std::move(registered), name);
}

}  // namespace thermovox
