#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/byte_order.hpp"
#include "projection/radiometry.hpp"

namespace thermovox::test {

/// How the counts lie in a FLIR frame.
enum class FlirPacking { raw_little = 2, raw_big = 1, png = 3, jpeg_ls = 4 };

/// A FLIR frame for a test; the defaults are what most cameras write.
struct FlirFile {
  int width = 160;
  int height = 120;
  std::vector<std::uint16_t> counts;  ///< row by row
  FlirPacking packing = FlirPacking::raw_little;
  ByteOrder container = ByteOrder::big;   ///< of header and directory
  ByteOrder records = ByteOrder::little;  ///< of the numbers in the records
  std::optional<ByteOrder> png_samples;   ///< default: that of the records, as cameras do
  std::string model = "FLIR E40";
  RadiometricParameters parameters;
  std::size_t camera_info_size = 2476;  ///< bytes; shorter ones end before the last fields
  bool picture_in_picture = false;
  std::string visible_jpeg;  ///< bytes of an embedded visible picture of 4 x 3 pixels; empty for none
};

/// The constants of a FLIR E40, and its usual surroundings.
[[nodiscard]] RadiometricParameters e40();
/// Counts that rise from corner to corner with a little noise, as of a calm scene; seeded.
[[nodiscard]] std::vector<std::uint16_t> calmCounts(int width, int height, std::uint64_t seed = 3);

/// The bytes of the frame (an FFF file).
[[nodiscard]] std::string flirFrame(const FlirFile& file);

/// How a frame is cut into the APP1 segments of a JPEG.
struct JpegCut {
  std::size_t piece_size = 65000;  ///< bytes
  bool numbered = true;            ///< 0/0 in every piece otherwise
  bool shuffled = false;           ///< the last piece first
  std::string before;              ///< segments in front of the pieces, as appSegment() makes them
};
/// A JPEG (of no picture) that holds the frame.
[[nodiscard]] std::string radiometricJpeg(const std::string& frame, const JpegCut& cut = {});
/// A segment: marker 0xE1 is APP1.
[[nodiscard]] std::string appSegment(std::uint8_t marker, const std::string& payload);
/// An Exif segment with make and model.
[[nodiscard]] std::string exifSegment(const std::string& make, const std::string& model);

/// The data as a zlib stream.
[[nodiscard]] std::string zlibbed(const std::string& data);
/// A PNG of one grey channel of 16 bits whose rows take turns with all five filters.
[[nodiscard]] std::string grey16Png(int width, int height, const std::vector<std::uint16_t>& samples);
/// A JPEG-LS picture of one channel of 16 bits.
[[nodiscard]] std::string jpegLs(int width, int height, const std::vector<std::uint16_t>& samples);

}  // namespace thermovox::test
