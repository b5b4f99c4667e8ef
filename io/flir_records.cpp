#include "io/flir_records.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "io/flir_camera_info.hpp"
#include "io/jpeg_ls_counts.hpp"
#include "io/pixel_claim.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

using namespace std::string_view_literals;

/// The samples begin here in a record of counts or of a picture.
constexpr std::size_t kPixelOffset = 0x20;

constexpr std::uint16_t kRawBigEndian = 1;
constexpr std::uint16_t kRawLittleEndian = 2;

/// A record of pixels begins with 2, which tells its byte order, width and height.
struct PixelRecord {
  ByteOrder order = ByteOrder::little;
  int width = 0;
  int height = 0;
  std::span<const std::byte> pixels;
};

PixelRecord pixelRecordOf(std::span<const std::byte> bytes, const std::string& what) {
  if (bytes.size() <= kPixelOffset) {
    throw DataError(what + " is cut off after " + std::to_string(bytes.size()) +
                    " bytes, expected more than 32");
  }
  const ByteOrder order =
      numberAt<std::uint16_t>(bytes, 0, ByteOrder::big) == 2 ? ByteOrder::big : ByteOrder::little;
  return {order, *numberAt<std::uint16_t>(bytes, 2, order), *numberAt<std::uint16_t>(bytes, 4, order),
          bytes.subspan(kPixelOffset)};
}

CountsPicture rawCounts(const PixelRecord& record, ByteOrder order, const std::string& what) {
  const std::size_t pixels = static_cast<std::size_t>(record.width) * static_cast<std::size_t>(record.height);
  if (pixels == 0 || record.pixels.size() / 2 < pixels) {
    throw DataError(what + " is cut off or damaged: it holds " + std::to_string(record.pixels.size()) +
                    " bytes of pixels, expected " + std::to_string(2 * pixels) + " for " +
                    std::to_string(record.width) + " x " + std::to_string(record.height) + " counts");
  }
  CountsPicture picture{record.width, record.height, std::vector<std::uint16_t>(pixels)};
  const auto* bytes = reinterpret_cast<const unsigned char*>(record.pixels.data());
  const std::size_t low = order == ByteOrder::little ? 0 : 1;
  for (std::size_t i = 0; i < pixels; ++i)
    picture.counts[i] = static_cast<std::uint16_t>(bytes[2 * i + low] | bytes[2 * i + 1 - low] << 8);
  return picture;
}

std::uint16_t swapped(std::uint16_t count) {
  return static_cast<std::uint16_t>(count << 8 | count >> 8);
}

/// How a picture looks in one byte order: the sum of the steps from pixel to pixel along its rows.
struct Roughness {
  std::uint64_t as_it_is = 0;
  std::uint64_t swapped = 0;
  bool tells = false;  ///< both bytes vary; otherwise the steps say nothing about their order
};

constexpr int kRoughRows = 32;  // of which a picture's roughness is told

Roughness roughnessOf(const CountsPicture& picture) {
  Roughness roughness;
  const auto width = static_cast<std::size_t>(picture.width);
  std::uint16_t any = 0;  // bits that are set somewhere, and those that are set everywhere
  std::uint16_t all = 0xFFFF;
  const std::size_t step = width * static_cast<std::size_t>(std::max(picture.height / kRoughRows, 1));
  for (std::size_t first = 0; first < picture.counts.size(); first += step) {
    const std::uint16_t* row = picture.counts.data() + first;
    std::uint32_t as_it_is = 0;  // of 65535 pixels at most
    std::uint32_t swapped_row = 0;
    for (std::size_t u = 0; u < width; ++u) {
      any |= row[u];
      all &= row[u];
    }
    for (std::size_t u = 1; u < width; ++u) {
      as_it_is += static_cast<std::uint32_t>(std::abs(row[u] - row[u - 1]));
      swapped_row += static_cast<std::uint32_t>(std::abs(swapped(row[u]) - swapped(row[u - 1])));
    }
    roughness.as_it_is += as_it_is;
    roughness.swapped += swapped_row;
  }
  const auto varying = static_cast<std::uint16_t>(any & ~all);
  const int high = std::popcount(static_cast<std::uint8_t>(varying >> 8));
  const int low = std::popcount(static_cast<std::uint8_t>(varying));
  roughness.tells = std::min(high, low) >= 1 && std::max(high, low) >= 5;
  return roughness;
}

/// The samples of a PNG in a record of little endian numbers are little endian as well, against the rule of
/// PNG, in every file seen. Where the other order gives a picture that is smoother by far, that one is taken.
void orderSamples(CountsPicture& picture, ByteOrder record_order) {
  constexpr std::uint64_t by_far = 4;
  const Roughness roughness = roughnessOf(picture);
  bool swap = record_order == ByteOrder::little;
  if (roughness.tells && roughness.as_it_is > by_far * roughness.swapped) swap = true;
  if (roughness.tells && roughness.swapped > by_far * roughness.as_it_is) swap = false;
  if (!swap) return;
  for (std::uint16_t& count : picture.counts) count = swapped(count);
}

CountsPicture packedCounts(const PixelRecord& record, const std::string& what) {
  if (beginsWith(record.pixels, "\x89PNG"sv)) {
    CountsPicture picture = decodePngCounts(record.pixels, what);
    orderSamples(picture, record.order);
    return picture;
  }
  return decodeJpegLsCounts(record.pixels, what);
}

EmbeddedPicture embeddedPicture(std::span<const std::byte> bytes, const std::string& what) {
  const PixelRecord record = pixelRecordOf(bytes, what);
  const bool png = beginsWith(record.pixels, "\x89PNG"sv);
  return {png ? EmbeddedPicture::Encoding::png : EmbeddedPicture::Encoding::jpeg,
          record.width,
          record.height,
          {record.pixels.begin(), record.pixels.end()}};
}

/// Always little endian: the ratio as a float, then six 16-bit numbers.
std::optional<PictureInPicture> pictureInPicture(std::span<const std::byte> bytes) {
  const auto ratio = numberAt<float>(bytes, 0, ByteOrder::little);
  if (bytes.size() < 16 || !(*ratio > 0.0F)) return std::nullopt;
  const auto number = [bytes](std::size_t offset) {
    return int{*numberAt<std::int16_t>(bytes, offset, ByteOrder::little)};
  };
  return PictureInPicture{*ratio, number(4), number(6), number(8), number(10), number(12), number(14)};
}

/// Bytes of a record; none where the frame has none of this type.
std::span<const std::byte> bytesOf(const FlirFrame& frame, FlirRecordType type, const std::string& what) {
  const std::optional<FlirRecord> record = frame.find(type);
  return record ? frame.bytesOf(*record, what) : std::span<const std::byte>();
}

/// Bytes of a record that the temperatures can do without: none also where they are cut off.
std::span<const std::byte> bytesIfThere(const FlirFrame& frame, FlirRecordType type) {
  const std::optional<FlirRecord> record = frame.find(type);
  if (!record || frame.bytesThere(*record).size() < record->size) return {};
  return frame.bytesThere(*record);
}

}  // namespace

bool measuresNoTemperatures(const std::string& model) {
  std::string words = " ";
  for (const char c : model) words += c == '_' || c == '-' ? ' ' : c;
  words += ' ';
  const bool family = words.find(" Vue ") != std::string::npos || words.find(" Duo ") != std::string::npos;
  return family && words.find(" R ") == std::string::npos;
}

CountsPicture flirCounts(const FlirFrame& frame) {
  const std::optional<FlirRecord> found = frame.find(FlirRecordType::raw_data);
  if (!found) throw DataError(frame.name() + ": the FLIR frame holds no counts (no record 0x01)");
  const std::string what = frame.name() + ": the record of the counts";
  const PixelRecord record = pixelRecordOf(frame.bytesThere(*found), what);
  const bool packed = beginsWith(record.pixels, "\x89PNG"sv) || beginsWith(record.pixels, "\xFF\xD8\xFF"sv);
  if (!packed) {
    const ByteOrder order = found->subtype == kRawBigEndian      ? ByteOrder::big
                            : found->subtype == kRawLittleEndian ? ByteOrder::little
                                                                 : record.order;
    return rawCounts(record, order, what);
  }
  CountsPicture picture = packedCounts(record, what);
  if (picture.width != record.width || picture.height != record.height) {
    throw DataError(what + " holds a picture of " + std::to_string(picture.width) + " x " +
                    std::to_string(picture.height) + ", expected " + std::to_string(record.width) + " x " +
                    std::to_string(record.height));
  }
  return picture;
}

RawThermalImage readFlirFrame(const FlirFrame& frame, VisibleInFrame visible) {
  CountsPicture picture = flirCounts(frame);
  RawThermalImage image{picture.width, picture.height, std::move(picture.counts)};
  FlirCameraInfo info =
      parseFlirCameraInfo(bytesOf(frame, FlirRecordType::camera_info, "the camera's record"));
  image.metadata = std::move(info.metadata);
  if (image.metadata.software.empty()) image.metadata.software = frame.creator();
  if (measuresNoTemperatures(image.metadata.model)) {
    image.rule = NotTemperature{"is of a " + image.metadata.model +
                                ", which measures no temperatures (only the models with an R do)"};
  } else if (info.parameters) {
    image.rule = *info.parameters;
  } else {
    image.rule = NotTemperature{"has no constants that turn its counts into temperatures"};
  }
  image.metadata.picture_in_picture =
      pictureInPicture(bytesIfThere(frame, FlirRecordType::picture_in_picture));
  if (visible == VisibleInFrame::leave_out) return image;
  if (const auto bytes = bytesIfThere(frame, FlirRecordType::embedded_image); bytes.size() > kPixelOffset)
    image.metadata.visible = embeddedPicture(bytes, frame.name() + ": the record of the visible picture");
  return image;
}

}  // namespace thermovox
