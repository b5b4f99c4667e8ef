#pragma once

#include <cstdint>
#include <vector>

namespace thermovox {

/// 8 bits a channel, row by row, r g b.
struct RgbPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

}  // namespace thermovox
