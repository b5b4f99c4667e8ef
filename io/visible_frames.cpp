#include "io/visible_frames.hpp"

#include <fstream>
#include <memory>
#include <utility>

#include "io/input_file.hpp"

namespace thermovox {
namespace {

Duration between(Time a, Time b) {
  return a < b ? b - a : a - b;
}

}  // namespace

VisibleFrames::VisibleFrames(const std::filesystem::path& list, const std::filesystem::path& folder,
                             const Camera& camera)
    : list_(std::make_unique<std::ifstream>(openInput(list)), list.string(), folder,
            StampedFiles::Pages::refuse),
      camera_(camera),
      after_(list_.next()) {}

std::optional<StampedFile> VisibleFrames::nearestFile(Time stamp, Duration within) {
  while (after_ && after_->stamp <= stamp) before_ = std::exchange(after_, list_.next());
  const bool later = after_ && (!before_ || between(after_->stamp, stamp) < between(before_->stamp, stamp));
  const std::optional<StampedFile>& chosen = later ? after_ : before_;
  if (!chosen || between(chosen->stamp, stamp) > within) return std::nullopt;
  return chosen;
}

std::optional<VisibleFrame> VisibleFrames::nearest(Time stamp, Duration within) {
  const std::optional<StampedFile> chosen = nearestFile(stamp, within);
  if (!chosen) return std::nullopt;
  return VisibleFrame{chosen->stamp, readVisiblePicture(chosen->file, chosen->place, camera_)};
}

}  // namespace thermovox
