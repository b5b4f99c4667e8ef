#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "apps/simulate/simulation.hpp"

namespace thermovox::simulate {

/// The parts of a mission folder (`folder` exists). All throw DataError naming the file that could not be
/// written.

/// mission.yaml and rig.yaml.
void writeDescriptions(const Simulation& simulation, const std::string& name,
                       const std::filesystem::path& folder);
/// trajectory.tum.
void writeTrajectory(const Simulation& simulation, const std::filesystem::path& folder);
/// thermal.csv and thermal/NNNNNN.tiff, or .jpg where the camera is to store radiometric JPEGs.
void writeThermalFrames(const Simulation& simulation, const std::filesystem::path& folder);
/// visible.csv and visible/NNNNNN.jpg. Precondition: the rig has a visible camera.
void writeVisiblePictures(const Simulation& simulation, const std::filesystem::path& folder);
/// beam.csv, scans.csv, or clouds.csv and clouds/NNNNNN.pcd. Returns how many echoes they hold.
[[nodiscard]] std::size_t writeLaser(const Simulation& simulation, const std::filesystem::path& folder);

}  // namespace thermovox::simulate
