#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/raw_thermal_image.hpp"

namespace thermovox {

/// The text of a property of an XMP packet, by its name without prefix, written as an attribute
/// (`Camera:Yaw="163.19"`) or as an element (`<Camera:Yaw>163.19</Camera:Yaw>`, of a list the first item
/// with its marks). The prefix, where one is given, must be `prefix`. nullopt where there is none.
[[nodiscard]] std::optional<std::string> xmpText(std::string_view packet, std::string_view name,
                                                 std::string_view prefix = {});

/// The same as a number, which may be written as a ratio (`16319/100`); nullopt also where it is none.
[[nodiscard]] std::optional<double> xmpNumber(std::string_view packet, std::string_view name,
                                              std::string_view prefix = {});

/// What a thermal camera writes: its scale, and in the property names of Pix4D's `Camera:` how it stands.
[[nodiscard]] XmpFacts xmpFacts(std::string_view packet);

}  // namespace thermovox
