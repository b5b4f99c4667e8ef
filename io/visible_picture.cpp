#include "io/visible_picture.hpp"

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "io/byte_order.hpp"
#include "io/input_file.hpp"
#include "io/jpeg_segments.hpp"
#include "io/pixel_claim.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 28;  // bytes
/// Pixels that a byte can hold at most: deflate packs 1032 bytes into one, JPEG a block of 64 into 2 bits.
constexpr double kPixelsPerByte = 1100.0;

struct PictureSize {
  int width = 0;
  int height = 0;
};

/// The size in a JPEG's start of frame (SOF0 to SOF15, but for the tables that share their numbers).
std::optional<PictureSize> jpegSize(const std::vector<JpegSegment>& segments) {
  for (const auto& [marker, payload] : segments) {
    if (marker < 0xC0 || marker > 0xCF || marker == 0xC4 || marker == 0xC8 || marker == 0xCC) continue;
    const auto height = numberAt<std::uint16_t>(payload, 1, ByteOrder::big);
    const auto width = numberAt<std::uint16_t>(payload, 3, ByteOrder::big);
    if (width && height) return PictureSize{*width, *height};
  }
  return std::nullopt;
}

std::optional<PictureSize> pngSize(std::span<const std::byte> bytes) {
  const auto width = numberAt<std::uint32_t>(bytes, 16, ByteOrder::big);
  const auto height = numberAt<std::uint32_t>(bytes, 20, ByteOrder::big);
  if (!width || !height || std::max(*width, *height) > 1U << 20) return std::nullopt;
  return PictureSize{static_cast<int>(*width), static_cast<int>(*height)};
}

/// The size that the header claims, of a picture that has its end.
PictureSize claimedSize(std::span<const std::byte> bytes, const std::string& name) {
  using namespace std::string_view_literals;
  const std::string_view text = charactersOf(bytes);
  std::optional<PictureSize> size;
  bool has_end = false;
  if (text.starts_with("\xFF\xD8"sv)) {
    const std::vector<JpegSegment> segments = jpegSegments(bytes);
    size = jpegSize(segments);
    if (!segments.empty()) {
      const auto& last = segments.back().payload;
      has_end = text.find("\xFF\xD9"sv, static_cast<std::size_t>(last.data() + last.size() - bytes.data())) !=
                std::string_view::npos;
    }
  } else if (text.starts_with("\x89PNG\r\n\x1A\n"sv)) {
    size = pngSize(bytes);
    has_end = text.find("IEND\xAE\x42\x60\x82"sv) != std::string_view::npos;
  } else {
    throw DataError(name + ": is neither a JPEG nor a PNG, expected a visible picture");
  }
  if (!has_end) throw DataError(name + ": is cut off, expected a whole picture");
  if (!size || size->width < 1 || size->height < 1 ||
      static_cast<double>(size->width) * size->height >
          std::min(double{kMostPixels}, kPixelsPerByte * static_cast<double>(bytes.size())))
    throw DataError(name + ": the size of the picture is damaged, expected one that its bytes can hold");
  return *size;
}

cv::Mat decoded(std::span<const std::byte> bytes, const std::string& name, int mode) {
  const PictureSize size = claimedSize(bytes, name);
  cv::Mat picture;
  try {
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8U, const_cast<std::byte*>(bytes.data()));
    picture = cv::imdecode(encoded, mode | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.cols != size.width || picture.rows != size.height)
    throw DataError(name + ": is damaged, expected a picture that can be decoded");
  return picture;
}

/// One channel of a picture.
VisiblePicture channelOf(const cv::Mat& picture, int channel) {
  cv::Mat luminance;
  cv::extractChannel(picture, luminance, channel);
  return {picture.cols, picture.rows, {luminance.begin<std::uint8_t>(), luminance.end<std::uint8_t>()}};
}

void checkSize(int width, int height, const std::filesystem::path& file, const Camera& camera) {
  if (width == camera.width() && height == camera.height()) return;
  throw DataError(file.string() + ": is " + std::to_string(width) + " x " + std::to_string(height) +
                  " pixels, expected " + std::to_string(camera.width()) + " x " +
                  std::to_string(camera.height()) + " as the rig's visible camera");
}

}  // namespace

VisiblePicture decodeVisiblePicture(std::span<const std::byte> bytes, const std::string& name) {
  return channelOf(decoded(bytes, name, cv::IMREAD_GRAYSCALE), 0);
}

VisiblePicture decodeVisiblePicture(const EmbeddedPicture& embedded, const std::string& name) {
  if (embedded.encoding == EmbeddedPicture::Encoding::jpeg) return decodeVisiblePicture(embedded.bytes, name);
  constexpr int kRed = 2;  // OpenCV's channels are blue, green, red
  return channelOf(decoded(embedded.bytes, name, cv::IMREAD_COLOR), kRed);
}

VisiblePicture readVisiblePicture(const std::filesystem::path& file, std::string_view named_by) {
  const std::string text = readWhole(file, named_by, kLargestFile);
  return decodeVisiblePicture(std::as_bytes(std::span(text)), file.string());
}

VisiblePicture readVisiblePicture(const std::filesystem::path& file, std::string_view named_by,
                                  const Camera& camera) {
  VisiblePicture picture = readVisiblePicture(file, named_by);
  checkSize(picture.width, picture.height, file, camera);
  return picture;
}

RgbPicture readColourPicture(const std::filesystem::path& file, std::string_view named_by,
                             const Camera& camera) {
  const std::string text = readWhole(file, named_by, kLargestFile);
  cv::Mat picture = decoded(std::as_bytes(std::span(text)), file.string(), cv::IMREAD_COLOR);
  checkSize(picture.cols, picture.rows, file, camera);
  cv::cvtColor(picture, picture, cv::COLOR_BGR2RGB);
  const auto* first = picture.ptr<std::uint8_t>();  // a decoded picture's rows have no gaps
  return {picture.cols, picture.rows, {first, first + picture.total() * picture.elemSize()}};
}

}  // namespace thermovox
