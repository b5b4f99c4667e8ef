#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "projection/radiometry.hpp"

namespace thermovox {

/// celsiusOfCounts() of whole counts, from a table that grows to the counts that were asked for: frames of
/// one scene cost a look-up a pixel.
class CelsiusTable {
 public:
  /// Throws ConfigError as validate() does.
  explicit CelsiusTable(const RadiometricParameters& parameters);

  [[nodiscard]] const RadiometricParameters& parameters() const { return parameters_; }
  /// Temperatures of the counts, in their order. Precondition: both spans have one size.
  void convert(std::span<const std::uint16_t> counts, std::span<float> celsius);

 private:
  void grow(std::size_t first, std::size_t last);
  void fill(std::size_t begin, std::size_t end);

  RadiometricParameters parameters_;
  std::vector<float> celsius_;  ///< of the counts from begin_ to end_ - 1
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

}  // namespace thermovox
