#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "projection/thermal_image.hpp"
#include "tests/projection/random_cameras.hpp"

namespace thermovox::test {

/// An image whose pixel (u, v) has the temperature celsius(u, v).
template <typename Celsius>
[[nodiscard]] ThermalImage imageOf(int width, int height, Celsius&& celsius) {
  ThermalImage image{.width = width, .height = height};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) image.celsius.push_back(static_cast<float>(celsius(u, v)));
  }
  return image;
}

[[nodiscard]] inline ThermalFrame frameOf(ThermalImage image, Time stamp = Time()) {
  return {.stamp = stamp, .image = std::make_shared<const ThermalImage>(std::move(image)), .name = "frame"};
}

}  // namespace thermovox::test
