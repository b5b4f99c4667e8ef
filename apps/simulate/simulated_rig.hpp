#pragma once

#include "apps/simulate/simulation_options.hpp"

namespace thermovox::simulate {

/// The rig as its file tells it: a thermal camera of the FLIR Duo R kind, 160 x 120, a visible one if
/// asked for, and one laser of the
/// asked kind (a LIDAR-Lite, a Hokuyo UTM-30LX, a spinning 16-beam laser), each with a mounting of its own.
[[nodiscard]] Rig makeRig(const SimulationOptions& options);

/// What the counts of its radiometric JPEGs mean: the options' surfaces, air and window, and the distance of
/// one metre that such cameras are mostly left at.
[[nodiscard]] RadiometricParameters makeRadiometry(const SimulationOptions& options);

/// Beams of the cloud laser, and the columns of one turn.
inline constexpr int kCloudBeams = 16;
inline constexpr int kCloudColumns = 512;
/// Elevation of a beam, radians: from -15 to +15 degrees in equal steps.
[[nodiscard]] double cloudElevation(int beam);
/// Readings of one sweep of the scanner.
inline constexpr int kScanReadings = 1081;

}  // namespace thermovox::simulate
