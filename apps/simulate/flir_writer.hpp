#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_order.hpp"
#include "io/flir_frame.hpp"
#include "projection/radiometry.hpp"

namespace thermovox::simulate {

/// A record of a FLIR frame to be written.
struct WrittenRecord {
  std::uint16_t type = 0;
  std::uint16_t subtype = 0;
  std::string bytes;
};

/// A record of pixels: 2, which tells the byte order, width, height, and the pixels from byte 32 on.
[[nodiscard]] std::string flirPixelRecord(int width, int height, std::string_view pixels, ByteOrder order);

/// What the record of the camera says.
struct WrittenCamera {
  RadiometricParameters parameters;
  std::string model, serial, lens;
  double range_low = 0.0;  ///< the calibrated range, C
  double range_high = 0.0;
  double field_of_view_deg = 0.0;
  std::uint32_t unix_seconds = 0;  ///< when the image was taken; 0: not known
  std::uint32_t milliseconds = 0;
  std::int16_t minutes_behind = 0;  ///< the camera's zone behind universal time
};

/// The camera's record, of so many bytes: fields beyond them are left out, as older cameras do. Offsets as
/// exiftool documents them.
[[nodiscard]] std::string flirCameraRecord(const WrittenCamera& camera, std::size_t size, ByteOrder order);

/// PictureInPicture as FLIR writes it: the ratio, then the offsets and the corners of the inset.
[[nodiscard]] std::string flirPictureInPictureRecord(float real_to_ir, const std::vector<std::int16_t>& rest);

/// A frame (FFF) of these records; `order` is that of its header and directory.
[[nodiscard]] std::string flirFrame(const std::vector<WrittenRecord>& records, std::string_view creator,
                                    ByteOrder order);

/// How a frame is cut into the APP1 segments of a JPEG.
struct FlirCut {
  std::size_t piece_size = 65000;  ///< bytes; a segment holds less than 65536
  bool numbered = true;            ///< 0/0 in every piece otherwise
};
[[nodiscard]] std::vector<std::string> flirSegments(std::string_view frame, const FlirCut& cut = {});

/// A segment of a JPEG: marker 0xE1 is APP1.
[[nodiscard]] std::string jpegSegment(std::uint8_t marker, std::string_view payload);

}  // namespace thermovox::simulate
