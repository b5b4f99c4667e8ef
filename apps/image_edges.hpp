#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "io/visible_edges.hpp"

namespace thermovox {

/// Where the edges in a picture of a thermal image come from: a visible picture and a rig, or the file
/// itself.
struct EdgeArgs {
  std::filesystem::path visible;
  std::filesystem::path rig;
  double range = 0.0;  ///< metres
  bool embedded = false;

  [[nodiscard]] bool wanted() const { return embedded || !visible.empty(); }
};

void addEdges(CLI::App& verb, EdgeArgs& args);

/// The visible picture on the pixels of a thermal image; null where no edges are asked for. `name` stands for
/// the thermal image in messages. Throws ConfigError for a rig without the two cameras and DataError for what
/// is missing, damaged, of another size than the rig says, or looks elsewhere.
[[nodiscard]] std::shared_ptr<const RegisteredPicture> registeredPicture(const EdgeArgs& args,
                                                                         const RawThermalImage& thermal,
                                                                         const std::string& name);

}  // namespace thermovox
