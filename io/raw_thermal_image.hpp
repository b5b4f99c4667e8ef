#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "projection/radiometry.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// Where FLIR's cameras put the thermal image into their visible one: it covers visible width / real_to_ir
/// visible pixels about (visible width / 2 + offset_x, visible height / 2 + offset_y). That is a parallax for
/// one distance only. The corners are those of the inset, in pixels of the thermal image.
struct PictureInPicture {
  double real_to_ir = 1.0;
  int offset_x = 0;  ///< visible pixels
  int offset_y = 0;
  int x1 = 0, x2 = 0, y1 = 0, y2 = 0;
};

/// The visible picture in a radiometric file, as it is stored there.
struct EmbeddedPicture {
  enum class Encoding { jpeg, png };
  Encoding encoding = Encoding::jpeg;
  int width = 0;
  int height = 0;
  std::vector<std::byte> bytes;
};

/// What an XMP packet of a thermal camera says; empty where it does not.
struct XmpFacts {
  std::optional<double> t_linear_gain;                 ///< kelvin a count; 0: counts are no temperatures
  std::optional<double> yaw_deg, pitch_deg, roll_deg;  ///< of the camera
  std::optional<double> focal_length_mm;
  std::vector<double> principal_point_mm;      ///< x, y
  std::vector<double> perspective_distortion;  ///< k1 k2 k3 p1 p2
};

/// What a file says of the camera and the moment; empty where it does not.
struct ThermalMetadata {
  std::string format;  ///< "FLIR radiometric JPEG"
  std::string make, model, serial, lens, software;
  std::string time;  ///< as the camera wrote it: ISO 8601 with its zone in FLIR frames, "YYYY:MM:DD hh:mm:ss"
                     ///< in EXIF and TIFF
  std::optional<double> field_of_view_deg;
  std::optional<CalibratedRange> calibrated_range;
  std::optional<PictureInPicture> picture_in_picture;
  std::optional<EmbeddedPicture> visible;
  XmpFacts xmp;
};

/// The pixels are temperatures already.
struct AlreadyCelsius {};

/// The counts are no temperatures; `reason` says why, the beginning of a sentence about the file: "is ...".
struct NotTemperature {
  std::string reason;
};

/// How the pixels become temperatures.
using CelsiusRule = std::variant<RadiometricParameters, TLinear, AlreadyCelsius, NotTemperature>;

/// Who says so.
enum class RuleSource {
  file,    ///< the file: its own parameters, or the scale in its XMP packet
  option,  ///< the user
  model,   ///< the camera's make and model
  counts,  ///< a guess, by where the counts lie
};

/// A thermal image as it is stored, row by row.
struct RawThermalImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> counts;  ///< empty where the pixels are temperatures
  std::vector<float> celsius;         ///< empty where they are counts; NaN is "not known"
  CelsiusRule rule = AlreadyCelsius{};
  RuleSource rule_source = RuleSource::file;
  ThermalMetadata metadata;
};

}  // namespace thermovox
