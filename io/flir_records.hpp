#pragma once

#include "io/flir_frame.hpp"
#include "io/png_counts.hpp"
#include "io/raw_thermal_image.hpp"
#include "io/thermal_recording.hpp"

namespace thermovox {

/// The counts of a frame: raw in either byte order, PNG or JPEG-LS, told by their first bytes. Throws
/// DataError naming the frame: no such record, cut off, of another size than the record says, or absurdly
/// large.
[[nodiscard]] CountsPicture flirCounts(const FlirFrame& frame);

/// A whole frame: counts, the parameters of its own camera record, and what else it says. Throws as
/// flirCounts() does. A camera that measures no temperatures makes the rule NotTemperature.
[[nodiscard]] RawThermalImage readFlirFrame(const FlirFrame& frame,
                                            VisibleInFrame visible = VisibleInFrame::read);

/// Cameras of the Vue and Duo families measure temperatures only where their name has an R of its own ("Vue
/// Pro R"); the others store constants all the same.
[[nodiscard]] bool measuresNoTemperatures(const std::string& model);

}  // namespace thermovox
