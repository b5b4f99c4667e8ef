#pragma once

#include <algorithm>
#include <vector>

#include "calibration/calibration_input.hpp"

namespace thermovox {

/// Which of a camera's parameters (places in Intrinsics::parameters) so many views of the board can
/// determine: none where the lens is to be kept or there are fewer than three views. Of Brown and Conrady's
/// coefficients k1 k2 p1 p2; the higher ones stay as they are: at 160 x 120 pixels k3 is not observable.
[[nodiscard]] inline std::vector<int> freeIntrinsics(const CameraGuess& camera, std::size_t views) {
  constexpr std::size_t kFewestViews = 3;
  constexpr int kBrownConradyFree = 4;
  if (camera.lens == CameraGuess::Lens::keep || views < kFewestViews) return {};
  std::vector<int> free{kFx, kFy, kCx, kCy};
  const int coefficients = camera.intrinsics.model == LensModel::pinhole ? 0
                           : camera.intrinsics.model == LensModel::brown_conrady
                               ? std::min(camera.intrinsics.distortion_count, kBrownConradyFree)
                               : camera.intrinsics.distortion_count;
  for (int i = 0; i < coefficients; ++i) free.push_back(kDistortion + i);
  return free;
}

}  // namespace thermovox
