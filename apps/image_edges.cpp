#include "apps/image_edges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/rig_file.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// Whether any pixel of the thermal image lies in the visible picture.
bool overlap(const RegisteredPicture& visible) {
  const VisiblePicture& picture = visible.picture;
  return std::any_of(visible.pixels.pixels.begin(), visible.pixels.pixels.end(),
                     [&](const Eigen::Vector2d& pixel) {
                       return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= picture.width - 1 &&
                              pixel.y() <= picture.height - 1;
                     });
}

RegisteredPicture byRig(const EdgeArgs& args, const RawThermalImage& thermal, const std::string& name) {
  const Rig rig = readRig(args.rig);
  if (!rig.thermal_camera || !rig.visible_camera) {
    throw ConfigError(fmt::format("{}: has no {}_camera, expected a rig with both cameras for --visible",
                                  args.rig.string(), rig.thermal_camera ? "visible" : "thermal"));
  }
  const Camera& camera = rig.thermal_camera->camera;
  if (thermal.width != camera.width() || thermal.height != camera.height()) {
    throw DataError(fmt::format("{}: is {} x {} pixels, expected {} x {} as the rig's thermal camera", name,
                                thermal.width, thermal.height, camera.width(), camera.height()));
  }
  const Pose T_visible_thermal =
      rig.visible_camera->T_body_camera.inverse() * rig.thermal_camera->T_body_camera;
  return {readVisiblePicture(args.visible, "--visible", rig.visible_camera->camera),
          registerPixels({camera, rig.visible_camera->camera, T_visible_thermal}, std::array{args.range})};
}

RegisteredPicture byRecord(const RawThermalImage& thermal, const std::string& name) {
  const auto& [visible, record] = std::pair(thermal.metadata.visible, thermal.metadata.picture_in_picture);
  if (!visible || !record) {
    throw DataError(fmt::format("{}: holds no {}, expected a FLIR file with both for --edges (or --visible)",
                                name,
                                visible ? "record of where its visible picture lies" : "visible picture"));
  }
  if (!(std::isfinite(record->real_to_ir) && record->real_to_ir > 0.0)) {
    throw DataError(fmt::format("{}: says Real2IR {}, expected a positive number", name, record->real_to_ir));
  }
  RegisteredPicture registered{decodeVisiblePicture(*visible, name + ": its visible picture"), {}};
  registered.pixels = pixelsByRecord(*record, thermal, registered.picture);
  return registered;
}

}  // namespace

void addEdges(CLI::App& verb, EdgeArgs& args) {
  CLI::Option* edges =
      verb.add_flag("--edges", args.embedded,
                    "Draw the edges of the visible picture in a FLIR file, laid over the thermal image as "
                    "the file says: for one distance, by the camera's own choice");
  CLI::Option* visible = verb.add_option("--visible", args.visible,
                                         "Draw the edges of this visible picture (JPEG, PNG), laid over the "
                                         "thermal image by --rig and --range")
                             ->excludes(edges);
  CLI::Option* rig = verb.add_option(
      "--rig", args.rig,
      "Rig of the camera: says what the counts of a TIFF are, where it has celsius_per_count, "
      "and how the visible camera of --visible stands");
  CLI::Option* range =
      verb.add_option(
              "--range", args.range,
              "How far the surface is from the thermal camera along its optical axis [m], not along "
              "the ray to each pixel: what a laser beside the camera measures on a wall that faces it")
          ->check(CLI::PositiveNumber)
          ->needs(visible);
  visible->needs(rig)->needs(range);
}

std::shared_ptr<const RegisteredPicture> registeredPicture(const EdgeArgs& args,
                                                           const RawThermalImage& thermal,
                                                           const std::string& name) {
  if (!args.wanted()) return nullptr;
  auto registered = std::make_shared<RegisteredPicture>(args.embedded ? byRecord(thermal, name)
                                                                      : byRig(args, thermal, name));
  if (!overlap(*registered)) {
    throw DataError(name +
                    ": no pixel of it lies in the visible picture, expected cameras that look the "
                    "same way");
  }
  return registered;
}

}  // namespace thermovox
