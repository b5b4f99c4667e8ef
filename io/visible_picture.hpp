#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/raw_thermal_image.hpp"
#include "io/rgb_picture.hpp"
#include "projection/camera.hpp"

namespace thermovox {

/// The brightness of a visible picture, row by row, 0 to 255. The orientation is as stored: turned by its
/// EXIF tag it would not fit the camera's calibration.
struct VisiblePicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> luminance;
};

/// Decodes a JPEG or a PNG; `name` stands for it in messages. Throws DataError for anything else, for one
/// that is cut off or damaged, and, before memory is taken, for one that claims more pixels than its bytes
/// can hold.
[[nodiscard]] VisiblePicture decodeVisiblePicture(std::span<const std::byte> bytes, const std::string& name);

/// The same from a file. `named_by` says who wants it and may be empty.
[[nodiscard]] VisiblePicture readVisiblePicture(const std::filesystem::path& file,
                                                std::string_view named_by = {});

/// The same, and throws DataError naming the file unless it has the size that the camera has by its rig.
[[nodiscard]] VisiblePicture readVisiblePicture(const std::filesystem::path& file, std::string_view named_by,
                                                const Camera& camera);

/// The same in colour, for people to look at.
[[nodiscard]] RgbPicture readColourPicture(const std::filesystem::path& file, std::string_view named_by,
                                           const Camera& camera);

/// The picture in a radiometric file. Where it is a PNG, FLIR's cameras write Y, Cr and Cb as if they were
/// red, green and blue (measured on a B60): its brightness is the first channel.
[[nodiscard]] VisiblePicture decodeVisiblePicture(const EmbeddedPicture& embedded, const std::string& name);

}  // namespace thermovox
