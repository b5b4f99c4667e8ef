#pragma once

#include <vector>

#include "apps/simulate/capture_scene.hpp"
#include "projection/laser/multi_beam.hpp"
#include "projection/laser/range_finder.hpp"

namespace thermovox::simulate {

/// What the laser of a scene measures of one capture (its number in captures()): the plate, and the room
/// behind it where the plate is not in the way; with noise along the ray and the capture's common bias.

/// 100 readings at 100 Hz. The beam's spot wanders on the board from reading to reading.
[[nodiscard]] std::vector<BeamReading> measureBeam(const CaptureScene& scene, std::size_t capture);

/// A sweep of a scanner as its file has it.
struct CaptureSweep {
  Time stamp;
  std::vector<float> ranges;  ///< metres
};
/// 20 sweeps of 1081 ranges at 20 Hz.
[[nodiscard]] std::vector<CaptureSweep> measureScans(const CaptureScene& scene, std::size_t capture);

/// One cloud: a grid of 0.45 x 0.5 degrees, 120 across and 60 high, of the front.
[[nodiscard]] std::vector<CloudPoint> measureCloud(const CaptureScene& scene, std::size_t capture);

/// The same of whatever laser the scene has, as the project's readers of lasers make it.
[[nodiscard]] std::vector<Reading> measureCapture(const CaptureScene& scene, std::size_t capture);

}  // namespace thermovox::simulate
