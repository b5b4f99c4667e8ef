#pragma once

#include <Eigen/Geometry>
#include <string>

namespace thermovox {

/// An SVG element around its content; `view` is what it shows, in the content's units.
[[nodiscard]] std::string svgOf(const Eigen::AlignedBox2d& view, const std::string& label,
                                const std::string& content);

/// A number with so many decimals, without a minus before zero; a dash for what is not finite.
[[nodiscard]] std::string numberText(double value, int decimals);

/// The least of 1, 2, 5 times a power of ten that is no less.
[[nodiscard]] double roundedUp(double value);

}  // namespace thermovox
