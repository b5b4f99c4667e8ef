#pragma once

#include <vector>

namespace thermovox {

/// An image with a board in it, row by row: counts or temperatures of a thermal camera, brightness of a
/// visible one. Only differences matter: its unit is nobody's business here.
struct BoardImage {
  int width = 0;
  int height = 0;
  std::vector<float> values;  ///< finite

  [[nodiscard]] float at(int u, int v) const {
    return values[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(u)];
  }
};

}  // namespace thermovox
