#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "io/picture_registration.hpp"

namespace thermovox {

/// Where the edges in a picture of a thermal image come from: a visible picture and a rig, or the file
/// itself.
struct EdgeArgs {
  PictureByRig by_rig;
  bool embedded = false;

  [[nodiscard]] bool wanted() const { return embedded || !by_rig.visible.empty(); }
};

/// Returns the two options that ask for edges.
std::vector<CLI::Option*> addEdges(CLI::App& verb, EdgeArgs& args);

/// The visible picture on the pixels of a thermal image; null where no edges are asked for. `name` stands for
/// the thermal image in messages. Throws as registerByRig() and registerByRecord() do.
[[nodiscard]] std::shared_ptr<const RegisteredPicture> registeredPicture(const EdgeArgs& args,
                                                                         const RawThermalImage& thermal,
                                                                         const std::string& name);

}  // namespace thermovox
