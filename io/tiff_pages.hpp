#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "io/raw_thermal_image.hpp"

namespace thermovox {

/// The tags of a page that say something about camera and scale; empty where it has none.
struct TiffTags {
  std::string make, model, serial, software, time;
  std::string xmp;  ///< the packet
};

/// The pages of a TIFF of thermal images, whose complaints become DataErrors and are never printed.
class TiffPages {
 public:
  /// Throws DataError, `name` first, where there is no TIFF.
  TiffPages(const std::filesystem::path& file, std::string name);
  TiffPages(std::span<const std::byte> bytes, std::string name);
  ~TiffPages();

  [[nodiscard]] int count() const;
  /// Counts or temperatures of a page from 0, without a rule. Throws DataError: no such page, truncated,
  /// another kind of pixel, absurdly large.
  [[nodiscard]] RawThermalImage read(int page);
  /// Of the page that was read last; of the first one before.
  [[nodiscard]] TiffTags tags() const;

 private:
  class File;
  std::unique_ptr<File> file_;
  int count_ = 0;
};

}  // namespace thermovox
