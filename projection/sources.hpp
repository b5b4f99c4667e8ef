#pragma once

#include <optional>

#include "projection/laser/laser_return.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// A stream of laser readings in ascending order of their stamps: a mission folder, a bag, an instrument.
class ReadingSource {
 public:
  virtual ~ReadingSource() = default;
  /// The next reading; nullopt at the end. Throws DataError naming file and line.
  [[nodiscard]] virtual std::optional<Reading> next() = 0;
};

/// A stream of thermal frames in ascending order of their stamps.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The next frame; nullopt at the end. Throws DataError naming the file.
  [[nodiscard]] virtual std::optional<ThermalFrame> next() = 0;
  /// The usual time from frame to frame; zero where there are fewer than two.
  [[nodiscard]] virtual Duration period() const = 0;
};

}  // namespace thermovox
