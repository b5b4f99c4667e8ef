#pragma once

#include <optional>
#include <string>

#include "io/raw_thermal_image.hpp"

namespace thermovox {

/// Who says what the counts of an image are besides its file, for messages.
struct ScaleOwner {
  std::string name;     ///< "the rig"
  std::string way_out;  ///< how a user says it: "--celsius-per-count"
};

/// What the user should hear of how an image's counts became temperatures, in one sentence that begins with
/// `image_name`: that their scale is a guess by their range, or that the owner's scale, which was taken,
/// contradicts the file's own (TlinearGain). nullopt where there is nothing to say.
[[nodiscard]] std::optional<std::string> scaleWarning(const RawThermalImage& image,
                                                      const std::string& image_name, const ScaleOwner& owner);

}  // namespace thermovox
