#include "io/svg_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/report_html.hpp"

namespace thermovox {

std::string svgOf(const Eigen::AlignedBox2d& view, const std::string& label, const std::string& content) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.1f} {:.1f} {:.1f} {:.1f}\" role=\"img\" "
             "aria-label=\"{}\" font-family=\"Liberation Sans, Arial, sans-serif\">\n",
             view.min().x(), view.min().y(), view.sizes().x(), view.sizes().y(), escaped(label)) +
         content + "</svg>\n";
}

std::string numberText(double value, int decimals) {
  if (!std::isfinite(value)) return "&ndash;";
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') text.erase(0, 1);
  return text;
}

double roundedUp(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value * (1.0 - 1e-9)) return digit * power;
  }
  return 10.0 * power;
}

}  // namespace thermovox
