#pragma once

#include <filesystem>
#include <string_view>

#include "projection/radiometry.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// Reads one image (from 0) of a thermal image file, whose kind is told by its content, not its name. A TIFF
/// is read as readThermalTiff does. Throws DataError naming the file and the kind when it is another one:
/// 8-bit pictures hold no temperatures. `named_by` says who wants the file, for the message when it does not
/// exist.
[[nodiscard]] ThermalImage readThermalImage(const std::filesystem::path& file, int page,
                                            const TLinear& t_linear, std::string_view named_by = {});

}  // namespace thermovox
