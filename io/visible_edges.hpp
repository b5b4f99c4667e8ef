#pragma once

#include <cstdint>
#include <vector>

#include "io/raw_thermal_image.hpp"
#include "io/visible_picture.hpp"
#include "projection/registration.hpp"

namespace thermovox {

/// A visible picture, and where the pixels of a thermal image lie in it.
struct RegisteredPicture {
  VisiblePicture picture;
  PixelMap pixels;
};

/// Where the pixels of a thermal image lie in the visible picture of the same FLIR file, by the file's own
/// record: for one distance only, without regard to the lenses. Precondition: real_to_ir is positive.
[[nodiscard]] PixelMap pixelsByRecord(const PictureInPicture& record, const RawThermalImage& thermal,
                                      const VisiblePicture& visible);

/// The visible picture as the thermal camera would see it.
struct ResampledPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> luminance;  ///< row by row
  std::vector<std::uint8_t> covered;    ///< 255 where the visible picture covers the pixel, 0 elsewhere
};

/// Brings the visible picture onto the pixels of the thermal image, each divided into zoom x zoom; a visible
/// picture that is finer than that is smoothed first.
[[nodiscard]] ResampledPicture resample(const RegisteredPicture& visible, int zoom);

}  // namespace thermovox
