#include "io/flir_recording.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "io/flir_frame.hpp"
#include "io/flir_records.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// A frame of any camera is smaller; a larger one is the rest of a damaged recording.
constexpr std::uint64_t kMostFrameBytes = std::uint64_t{1} << 28;

struct FramePlace {
  std::uint64_t begin = 0;
  std::uint64_t size = 0;
  bool damaged = false;  ///< its directory is, and its counts cannot be found
};

/// The next place where a header begins; nullopt where there is none up to the end.
std::optional<std::uint64_t> nextHeader(ByteSource& source, std::uint64_t from) {
  if (parseFlirHeader(source.read(from, kFlirHeaderSize))) return from;  // nearly always just there
  constexpr std::uint64_t block = 1 << 16;
  for (std::uint64_t place = from + 1; place + kFlirHeaderSize <= source.size(); place += block) {
    const std::vector<std::byte> bytes = source.read(place, block + kFlirHeaderSize - 1);
    const std::span<const std::byte> window = bytes;
    for (std::size_t i = 0; i + kFlirHeaderSize <= window.size(); ++i) {
      if (parseFlirHeader(window.subspan(i, kFlirHeaderSize))) return place + i;
    }
  }
  return std::nullopt;
}

/// How large the frame is that begins here, by its directory.
std::uint64_t frameSizeAt(ByteSource& source, std::uint64_t begin) {
  const std::vector<std::byte> head = source.read(begin, kFlirHeaderSize);
  const FlirHeader header = *parseFlirHeader(head);
  const std::vector<std::byte> directory =
      source.read(begin + header.directory_offset, std::uint64_t{header.entries} * kFlirEntrySize);
  return flirFrameSize(header, parseFlirDirectory(directory, header));
}

class FlirRecording final : public ThermalRecording {
 public:
  FlirRecording(ByteSource source, VisibleInFrame visible) : source_(std::move(source)), visible_(visible) {
    for (auto begin = nextHeader(source_, 0); begin;) {
      const std::uint64_t left = source_.size() - *begin;
      FramePlace place{*begin, frameSizeAt(source_, *begin)};
      if (place.size > left) {  // it is cut off, or its directory is damaged: then the next one is not
        const auto next = nextHeader(source_, *begin + kFlirHeaderSize);
        place.size = (next ? *next : source_.size()) - *begin;
        place.damaged = place.size > kMostFrameBytes || !isDecodable(place);
        places_.push_back(place);
        begin = next;
        continue;
      }
      places_.push_back(place);
      begin = nextHeader(source_, *begin + place.size);
    }
    for (; !places_.empty() && places_.back().damaged; places_.pop_back()) ++damaged_;
    if (places_.empty()) {
      throw DataError(source_.name() + ": is a FLIR recording whose first frame is cut off after " +
                      std::to_string(source_.size()) + " bytes or damaged, expected a whole frame");
    }
  }

  int frames() const override { return static_cast<int>(places_.size()); }

  RawThermalImage read(int frame) override {
    if (frame < 0 || frame >= frames()) {
      throw DataError(source_.name() + ": has no frame " + std::to_string(frame) + ", expected 0 to " +
                      std::to_string(frames() - 1) +
                      (damaged_ > 0 ? " (" + std::to_string(damaged_) + " more cut off or damaged)" : ""));
    }
    const FramePlace& place = places_[static_cast<std::size_t>(frame)];
    const std::string name =
        frames() == 1 ? source_.name() : source_.name() + ", frame " + std::to_string(frame);
    if (place.damaged) throw DataError(name + ": is damaged, its counts do not lie where it says");
    const std::vector<std::byte> bytes = source_.read(place.begin, place.size);
    RawThermalImage image = readFlirFrame(FlirFrame(bytes, name), visible_);
    image.metadata.format = frames() == 1 ? "FLIR frame" : "FLIR recording";
    return image;
  }

 private:
  /// Whether a frame that is cut off holds its counts all the same.
  bool isDecodable(const FramePlace& place) {
    const std::vector<std::byte> bytes = source_.read(place.begin, place.size);
    try {
      static_cast<void>(readFlirFrame(FlirFrame(bytes, source_.name())));
      return true;
    } catch (const DataError&) {
      return false;
    }
  }

  ByteSource source_;
  VisibleInFrame visible_;
  std::vector<FramePlace> places_;
  int damaged_ = 0;  ///< frames that are left out
};

}  // namespace

std::unique_ptr<ThermalRecording> openFlirRecording(ByteSource source, VisibleInFrame visible) {
  return std::make_unique<FlirRecording>(std::move(source), visible);
}

}  // namespace thermovox
