#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/stamped_files.hpp"
#include "io/visible_picture.hpp"

namespace thermovox {

/// A picture of a mission's visible camera.
struct VisibleFrame {
  Time stamp;
  VisiblePicture picture;
};

/// The pictures that a mission's visible.csv lists, each read when it is asked for.
class VisibleFrames {
 public:
  /// `folder` is what the files of the list are relative to. Throws DataError as openInput does.
  VisibleFrames(const std::filesystem::path& list, const std::filesystem::path& folder, const Camera& camera);

  /// The picture nearest in time, at most `within` away; nullopt when there is none. Stamps have to ascend
  /// from call to call. Throws DataError for a damaged list, and for a picture that is missing, damaged or of
  /// another size than the camera.
  [[nodiscard]] std::optional<VisibleFrame> nearest(Time stamp, Duration within);
  /// Which file that is, without reading it.
  [[nodiscard]] std::optional<StampedFile> nearestFile(Time stamp, Duration within);

 private:
  StampedFiles list_;
  Camera camera_;
  std::optional<StampedFile> before_;
  std::optional<StampedFile> after_;
};

}  // namespace thermovox
