#pragma once

#include <memory>

#include "io/byte_source.hpp"
#include "io/thermal_recording.hpp"

namespace thermovox {

/// FLIR frames one after the other (SEQ, CSQ, or a single FFF), each with a camera record of its own. Where a
/// frame ends follows from its directory, and the next begins with the first header after that. A last frame
/// whose counts are cut off, as in a recording that an empty battery ended, is left out; a damaged one before
/// others keeps its number, and reading it is a DataError. Throws DataError when there is no whole frame.
[[nodiscard]] std::unique_ptr<ThermalRecording> openFlirRecording(
    ByteSource source, VisibleInFrame visible = VisibleInFrame::read);

}  // namespace thermovox
