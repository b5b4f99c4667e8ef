#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/raw_thermal_image.hpp"

namespace thermovox {

/// A file of thermal images: one image, the pages of a TIFF, the frames of a recording.
class ThermalRecording {
 public:
  virtual ~ThermalRecording() = default;
  /// How many whole frames there are, 1 or more.
  [[nodiscard]] virtual int frames() const = 0;
  /// A frame, from 0, with the orientation it is stored in. Throws DataError naming the file: no such frame,
  /// damaged, or absurdly large.
  [[nodiscard]] virtual RawThermalImage read(int frame) = 0;
};

/// What is done with the visible picture in a FLIR frame, which may be larger than all the rest of it.
enum class VisibleInFrame { read, leave_out };

struct RecordingOptions {
  /// The scale of a TIFF of counts, above all that the file itself says. Other formats have their own.
  std::optional<TLinear> t_linear;
  /// Who wants the file, for the message when it does not exist.
  std::string named_by;
  VisibleInFrame visible = VisibleInFrame::read;
};

/// Opens a file, whose kind is told by its content, not its name: radiometric JPEG of FLIR (also of DJI's
/// Zenmuse XT), FLIR recording (SEQ, CSQ, FFF), TIFF. Throws DataError naming the file and what it is instead
/// where it holds no temperatures and no counts: a picture, a JPEG of another DJI camera.
[[nodiscard]] std::unique_ptr<ThermalRecording> openThermalRecording(const std::filesystem::path& file,
                                                                     const RecordingOptions& options = {});

/// The same from bytes, which have to outlive it; `name` stands for the file in messages.
[[nodiscard]] std::unique_ptr<ThermalRecording> openThermalRecording(std::span<const std::byte> bytes,
                                                                     const std::string& name,
                                                                     const RecordingOptions& options = {});

}  // namespace thermovox
