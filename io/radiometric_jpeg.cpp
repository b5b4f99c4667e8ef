#include "io/radiometric_jpeg.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "io/byte_order.hpp"
#include "io/exif.hpp"
#include "io/flir_frame.hpp"
#include "io/flir_records.hpp"
#include "io/jpeg_segments.hpp"
#include "io/xmp.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

using namespace std::string_view_literals;

constexpr std::uint8_t kApp1 = 0xE1;
constexpr std::uint8_t kApp3 = 0xE3;
constexpr std::uint8_t kApp4 = 0xE4;

constexpr auto kFlir = "FLIR\0"sv;
constexpr auto kExif = "Exif\0\0"sv;
constexpr auto kXmp = "http://ns.adobe.com/xap/1.0/\0"sv;

/// A piece of a FLIR frame: after the name come a 1, its number and the number of the last piece.
struct Piece {
  unsigned number = 0;
  unsigned last = 0;
  std::span<const std::byte> data;
};

std::vector<Piece> piecesOf(std::span<const JpegSegment> segments) {
  std::vector<Piece> pieces;
  for (const JpegSegment& segment : segments) {
    if (segment.marker != kApp1 || segment.payload.size() < 8 || !beginsWith(segment.payload, kFlir))
      continue;
    pieces.push_back({std::to_integer<unsigned>(segment.payload[6]),
                      std::to_integer<unsigned>(segment.payload[7]), segment.payload.subspan(8)});
  }
  return pieces;
}

std::vector<std::byte> joined(std::vector<Piece> pieces, const std::string& name) {
  const unsigned last = std::max_element(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
                          return a.last < b.last;
                        })->last;
  if (last > 0) {
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.number < b.number; });
    const auto same = [](const Piece& a, const Piece& b) { return a.number == b.number; };
    pieces.erase(std::unique(pieces.begin(), pieces.end(), same), pieces.end());
    for (unsigned i = 0; i <= last; ++i) {
      if (i < pieces.size() && pieces[i].number == i) continue;
      throw DataError(name + ": piece " + std::to_string(i + 1) + " of " + std::to_string(last + 1) +
                      " of its FLIR frame is missing, expected the file as the camera wrote it");
    }
    pieces.resize(last + 1);
  }
  std::vector<std::byte> bytes;
  for (const Piece& piece : pieces) bytes.insert(bytes.end(), piece.data.begin(), piece.data.end());
  return bytes;
}

/// What stands behind the name of the first APP1 segment of this kind; empty where there is none.
std::span<const std::byte> app1Of(std::span<const JpegSegment> segments, std::string_view kind) {
  for (const JpegSegment& segment : segments) {
    if (segment.marker == kApp1 && beginsWith(segment.payload, kind))
      return segment.payload.subspan(kind.size());
  }
  return {};
}

/// DJI's own radiometric JPEGs keep their counts and constants in APP3 and APP4.
bool isDjiRadiometric(std::span<const JpegSegment> segments, const ExifFacts& exif) {
  std::size_t raw_bytes = 0;
  bool constants = false;
  for (const JpegSegment& segment : segments) {
    if (segment.marker == kApp3 || segment.marker == kApp4) raw_bytes += segment.payload.size();
    constants = constants || (segment.marker == kApp4 && beginsWith(segment.payload, "\xAA\x55\x12\x06"sv));
  }
  constexpr std::size_t too_many_for_a_photo = 100'000;
  return constants || (exif.make == "DJI" && raw_bytes > too_many_for_a_photo);
}

/// Why a JPEG without a FLIR frame holds no temperatures.
std::string refusal(std::span<const JpegSegment> segments) {
  const ExifFacts exif = exifFacts(app1Of(segments, kExif));
  if (isDjiRadiometric(segments, exif)) {
    return "is a radiometric JPEG of DJI" + (exif.model.empty() ? "" : " (" + exif.model + ")") +
           ", whose temperatures only DJI's own software can compute; convert it to a TIFF in Celsius (DJI "
           "Thermal Analysis Tool, or dji_irp of DJI's Thermal SDK) and read that";
  }
  const std::string_view xmp = charactersOf(app1Of(segments, kXmp));
  const std::string camera = xmpText(xmp, "CameraModel").value_or(exif.model);
  if (exif.make.starts_with("FLIR") || measuresNoTemperatures(camera) || camera.starts_with("Duo ")) {
    return "is a picture by " + (camera.empty() ? exif.make : camera) +
           " without radiometric data (no FLIR segment), expected the file as a radiometric camera wrote it, "
           "not one that was edited or exported";
  }
  return "is a JPEG without radiometric data (no FLIR segment): the colours of a picture hold no "
         "temperatures, expected a radiometric JPEG of a FLIR camera or a Zenmuse XT";
}

class RadiometricJpeg final : public ThermalRecording {
 public:
  RadiometricJpeg(std::span<const std::byte> bytes, std::string name, VisibleInFrame visible)
      : name_(std::move(name)), visible_(visible) {
    const std::vector<JpegSegment> segments = jpegSegments(bytes);
    frame_ = flirFrameOfJpeg(bytes, name_);
    exif_ = exifFacts(app1Of(segments, kExif));
    xmp_ = xmpFacts(charactersOf(app1Of(segments, kXmp)));
  }

  int frames() const override { return 1; }

  RawThermalImage read(int frame) override {
    if (frame != 0)
      throw DataError(name_ + ": has no frame " + std::to_string(frame) + ", expected 0: a JPEG has one");
    RawThermalImage image = readFlirFrame(FlirFrame(frame_, name_), visible_);
    ThermalMetadata& metadata = image.metadata;
    metadata.format = "FLIR radiometric JPEG";
    metadata.make = exif_.make;
    if (metadata.model.empty()) metadata.model = exif_.model;
    if (metadata.time.empty()) metadata.time = exif_.time;
    metadata.xmp = xmp_;
    return image;
  }

 private:
  std::string name_;
  VisibleInFrame visible_;
  std::vector<std::byte> frame_;
  ExifFacts exif_;
  XmpFacts xmp_;
};

}  // namespace

std::vector<std::byte> flirFrameOfJpeg(std::span<const std::byte> bytes, const std::string& name) {
  const std::vector<JpegSegment> segments = jpegSegments(bytes);
  std::vector<Piece> pieces = piecesOf(segments);
  if (pieces.empty()) throw DataError(name + ": " + refusal(segments));
  return joined(std::move(pieces), name);
}

std::unique_ptr<ThermalRecording> openRadiometricJpeg(std::span<const std::byte> bytes,
                                                      const std::string& name, VisibleInFrame visible) {
  return std::make_unique<RadiometricJpeg>(bytes, name, visible);
}

}  // namespace thermovox
