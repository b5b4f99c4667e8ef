#include "io/scale_warning.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thermovox {
namespace {

/// Gain and offset as good as the same: what a few digits in a text leave.
bool agree(const TLinear& t_linear, double gain) {
  constexpr double rounding = 1e-6;         // of the gain
  constexpr double offset_rounding = 0.01;  // C
  return std::abs(t_linear.celsius_per_count - gain) <= rounding * gain &&
         std::abs(t_linear.celsius_offset - kAbsoluteZero) <= offset_rounding;
}

std::string textOf(const TLinear& t_linear) {
  return fmt::format("{} C a count above {} C", t_linear.celsius_per_count, t_linear.celsius_offset);
}

}  // namespace

std::optional<std::string> scaleWarning(const RawThermalImage& image, const std::string& image_name,
                                        const ScaleOwner& owner) {
  const auto* t_linear = std::get_if<TLinear>(&image.rule);
  if (t_linear == nullptr) return std::nullopt;
  if (image.rule_source == RuleSource::counts) {
    return fmt::format(
        "{}: does not say what its counts mean; by their range they are taken for {} (where that is wrong, "
        "give {})",
        image_name, textOf(*t_linear), owner.way_out);
  }
  const std::optional<double>& gain = image.metadata.xmp.t_linear_gain;
  if (image.rule_source != RuleSource::option || !gain || agree(*t_linear, *gain)) return std::nullopt;
  const std::string own =
      *gain > 0.0 ? textOf({*gain, kAbsoluteZero}) : std::string("no temperatures (TlinearGain 0)");
  return fmt::format("{}: its counts are {} by the file itself, but {} by {}, which is taken", image_name,
                     own, textOf(*t_linear), owner.name);
}

}  // namespace thermovox
