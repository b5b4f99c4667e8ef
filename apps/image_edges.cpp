#include "apps/image_edges.hpp"

#include "apps/arguments.hpp"

namespace thermovox {

std::vector<CLI::Option*> addEdges(CLI::App& verb, EdgeArgs& args) {
  CLI::Option* edges =
      verb.add_flag("--edges", args.embedded,
                    "Draw the edges of the visible picture in a FLIR file, laid over the thermal image as "
                    "the file says: for one distance, by the camera's own choice");
  CLI::Option* visible =
      verb.add_option("--visible", args.by_rig.visible,
                      "Draw the edges of this visible picture (JPEG, PNG), laid over the "
                      "thermal image by --rig and --range: at one distance nothing hides anything")
          ->excludes(edges);
  CLI::Option* rig = verb.add_option(
      "--rig", args.by_rig.rig,
      "Rig of the camera: says what the counts of a TIFF are, where it has celsius_per_count, "
      "and how the visible camera of --visible stands");
  CLI::Option* range =
      verb.add_option(
              "--range", args.by_rig.range,
              "How far the surface is from the thermal camera along its optical axis [m], not along "
              "the ray to each pixel: what a laser beside the camera measures on a wall that faces it")
          ->check(CLI::PositiveNumber)
          ->check(isFinite())
          ->needs(visible);
  visible->needs(rig)->needs(range);
  return {edges, visible};
}

std::shared_ptr<const RegisteredPicture> registeredPicture(const EdgeArgs& args,
                                                           const RawThermalImage& thermal,
                                                           const std::string& name) {
  if (!args.wanted()) return nullptr;
  return std::make_shared<RegisteredPicture>(args.embedded ? registerByRecord(thermal, name)
                                                           : registerByRig(args.by_rig, thermal, name));
}

}  // namespace thermovox
