#include "io/thermal_recording.hpp"

#include <array>
#include <utility>

#include "io/byte_order.hpp"
#include "io/flir_recording.hpp"
#include "io/input_file.hpp"
#include "io/radiometric_jpeg.hpp"
#include "io/thermal_tiff.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

using namespace std::string_view_literals;

enum class Kind { tiff, jpeg, flir };

struct Magic {
  std::string_view bytes;
  Kind kind;
};
constexpr std::array kMagics{Magic{"II*\0"sv, Kind::tiff},        Magic{"MM\0*"sv, Kind::tiff},
                             Magic{"II+\0"sv, Kind::tiff},        Magic{"MM\0+"sv, Kind::tiff},
                             Magic{"\xFF\xD8\xFF"sv, Kind::jpeg}, Magic{"FFF\0"sv, Kind::flir},
                             Magic{"AFF\0"sv, Kind::flir}};

struct OtherKind {
  std::string_view magic;
  std::string_view name;
};
constexpr std::array kOtherKinds{OtherKind{"\x89PNG"sv, "a PNG picture"sv},
                                 OtherKind{"BM"sv, "a BMP picture"sv},
                                 OtherKind{"GIF8"sv, "a GIF picture"sv}};

/// A radiometric JPEG is 0.1 to 3 MB.
constexpr std::size_t kLargestJpeg = std::size_t{1} << 28;

Kind kindOf(std::span<const std::byte> beginning, const std::string& name) {
  for (const auto& [bytes, kind] : kMagics) {
    if (beginsWith(beginning, bytes)) return kind;
  }
  std::string found = beginning.empty() ? "is empty" : "is no image of a known kind";
  for (const auto& [magic, other] : kOtherKinds) {
    if (beginsWith(beginning, magic)) found = "is " + std::string(other);
  }
  throw DataError(name + ": " + found +
                  ", expected a radiometric JPEG, a FLIR recording, or a TIFF of 16-bit counts or 32-bit "
                  "floats in Celsius");
}

/// A JPEG that keeps the bytes of its file only while it is opened.
std::unique_ptr<ThermalRecording> openJpegFile(const std::filesystem::path& file,
                                               const RecordingOptions& options) {
  const std::string bytes = readWhole(file, options.named_by, kLargestJpeg);
  return openRadiometricJpeg(std::as_bytes(std::span(bytes)), file.string(), options.visible);
}

}  // namespace

std::unique_ptr<ThermalRecording> openThermalRecording(const std::filesystem::path& file,
                                                       const RecordingOptions& options) {
  ByteSource source(file, options.named_by);
  switch (kindOf(source.read(0, 8), file.string())) {
    case Kind::tiff:
      return openThermalTiff(file, options);
    case Kind::jpeg:
      return openJpegFile(file, options);
    case Kind::flir:
      break;
  }
  return openFlirRecording(std::move(source), options.visible);
}

std::unique_ptr<ThermalRecording> openThermalRecording(std::span<const std::byte> bytes,
                                                       const std::string& name,
                                                       const RecordingOptions& options) {
  switch (kindOf(bytes, name)) {
    case Kind::tiff:
      return openThermalTiff(bytes, name, options);
    case Kind::jpeg:
      return openRadiometricJpeg(bytes, name, options.visible);
    case Kind::flir:
      break;
  }
  return openFlirRecording(ByteSource(bytes, name), options.visible);
}

}  // namespace thermovox
