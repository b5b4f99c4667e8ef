#include "io/jpeg_ls_counts.hpp"

#include <optional>

#include "io/byte_order.hpp"
#include "io/jpeg_ls_scan.hpp"
#include "io/pixel_claim.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr unsigned kStartOfFrame = 0xF7;
constexpr unsigned kPresets = 0xF8;
constexpr unsigned kStartOfScan = 0xDA;
constexpr unsigned kRestartInterval = 0xDD;

/// What stands before the bits of the pixels.
struct Header {
  int bits = 0;
  int channels = 0;
  std::size_t width = 0;
  std::size_t height = 0;
  std::optional<JpegLsCoding> coding;
  int near = 0;
  std::size_t scan = 0;  ///< where the bits begin
};

class HeaderReader {
 public:
  HeaderReader(std::span<const std::byte> bytes, const std::string& what) : bytes_(bytes), what_(what) {}

  Header read() {
    Header header;
    std::size_t place = 2;  // after the start of the image
    while (header.scan == 0) {
      const unsigned marker = number<std::uint16_t>(place);
      if (marker < 0xFF00) refuse("no marker stands where one should");
      const std::size_t length = number<std::uint16_t>(place + 2);
      readSegment(marker & 0xFF, place + 4, header);
      if ((marker & 0xFF) == kStartOfScan) header.scan = place + 2 + length;
      place += 2 + length;
    }
    if (header.channels == 0) refuse("it has no frame header");
    return header;
  }

 private:
  template <typename T>
  unsigned number(std::size_t place) const {
    const auto value = numberAt<T>(bytes_, place, ByteOrder::big);
    if (!value) refuse("it ends in its header");
    return *value;
  }

  [[noreturn]] void refuse(const char* why) const {
    throw DataError(what_ + " is a damaged JPEG-LS picture: " + why);
  }

  void readSegment(unsigned marker, std::size_t place, Header& header) const {
    if (marker == kStartOfFrame) {
      header.bits = static_cast<int>(number<std::uint8_t>(place));
      header.height = number<std::uint16_t>(place + 1);
      header.width = number<std::uint16_t>(place + 3);
      header.channels = static_cast<int>(number<std::uint8_t>(place + 5));
    } else if (marker == kPresets && number<std::uint8_t>(place) == 1) {
      const auto preset = [&](std::size_t i) {
        return static_cast<int>(number<std::uint16_t>(place + 1 + 2 * i));
      };
      header.coding = JpegLsCoding{preset(0), 0, preset(1), preset(2), preset(3), preset(4)};
    } else if (marker == kRestartInterval && number<std::uint16_t>(place) != 0) {
      refuse("it restarts on its way, which no thermal camera does");
    } else if (marker == kStartOfScan) {
      header.near = static_cast<int>(number<std::uint8_t>(place + 3));
    }
  }

  std::span<const std::byte> bytes_;
  const std::string& what_;
};

/// The coding of the picture: its own presets, in which 0 stands for what is usual.
JpegLsCoding codingOf(const Header& header, const std::string& what) {
  const int largest = (1 << header.bits) - 1;
  if (!header.coding) return usualJpegLsCoding(largest, header.near);
  const int max_value = header.coding->max_value == 0 ? largest : header.coding->max_value;
  JpegLsCoding coding = usualJpegLsCoding(max_value, header.near);
  if (header.coding->t1 != 0) coding.t1 = header.coding->t1;
  if (header.coding->t2 != 0) coding.t2 = header.coding->t2;
  if (header.coding->t3 != 0) coding.t3 = header.coding->t3;
  if (header.coding->reset != 0) coding.reset = header.coding->reset;
  const bool ascending = coding.near < coding.t1 && coding.t1 <= coding.t2 && coding.t2 <= coding.t3;
  if (coding.max_value > largest || coding.t3 > coding.max_value || !ascending || coding.reset < 3)
    throw DataError(what + " is a damaged JPEG-LS picture: its presets cannot be");
  return coding;
}

}  // namespace

CountsPicture decodeJpegLsCounts(std::span<const std::byte> bytes, const std::string& what) {
  const Header header = HeaderReader(bytes, what).read();
  if (header.channels != 1 || header.bits < 9 || header.bits > 16) {
    throw DataError(what + " is a JPEG-LS picture with " + std::to_string(header.channels) +
                    " channel(s) of " + std::to_string(header.bits) +
                    " bits, expected one channel of 9 to 16 bits");
  }
  checkClaim({header.width, header.height, 2, bytes.size()}, what);
  if (header.scan >= bytes.size()) throw DataError(what + " is a damaged JPEG-LS picture: it has no pixels");
  CountsPicture picture{static_cast<int>(header.width), static_cast<int>(header.height),
                        std::vector<std::uint16_t>(header.width * header.height)};
  decodeJpegLsScan(bytes.subspan(header.scan), codingOf(header, what), header.width, picture.counts, what);
  return picture;
}

}  // namespace thermovox
