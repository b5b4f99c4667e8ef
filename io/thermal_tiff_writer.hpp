#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "io/atomic_file.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// What a TIFF is to be, and what it says of its camera and of its counts.
struct TiffPlan {
  int pages = 1;
  std::string make, model;
  /// Kelvin a count; 0 says that the counts are no temperatures. Floats and other scales go without.
  std::optional<double> t_linear_gain;
  bool big = false;  ///< a BigTIFF also where a TIFF would do
};

/// Writes a TIFF page by page, uncompressed, little endian: 32-bit floats in Celsius or counts of 16 bits. It
/// is a BigTIFF where 4 GB would not do. Holds one page at a time; the file appears whole, by commit(), or
/// not at all.
class ThermalTiffWriter {
 public:
  /// Throws DataError as AtomicFile does.
  ThermalTiffWriter(const std::filesystem::path& path, Existing existing, TiffPlan plan);

  /// Throws DataError when the pages grow so much that they are more than the file can hold.
  void add(const ThermalImage& image);
  void add(int width, int height, std::span<const std::uint16_t> counts);
  void commit();

 private:
  struct Page;
  void write(const Page& page);

  std::string name_;
  AtomicFile file_;
  TiffPlan plan_;
  int pages_left_ = 0;
  std::uint64_t place_ = 0;  ///< bytes written
};

}  // namespace thermovox
