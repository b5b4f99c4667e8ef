#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "io/folder_events.hpp"

namespace thermovox {

/// The images of a camera as they appear in its folder and the folders in it (DCIM/100FLIR, 101FLIR, ...):
/// each once, when it is wholly written. The folder may vanish and come back, as a card does that is
/// unmounted and mounted again, with other times of change (a card's clock has no time zone): what was given
/// is not given again. A file whose content has changed is a new image; of files beyond 128 KiB that keep
/// their size, the content is compared in 16 pieces from the first bytes to the last.
class CameraFolder {
 public:
  enum class Order {
    oldest_first,  ///< in the order of their times of change
    newest_first,  ///< of those that are there the newest; the others follow
  };
  struct Options {
    Order order = Order::oldest_first;
    /// A file is wholly written when the kernel says that it was closed; where nothing is heard of it, when
    /// its size and time of change have stood still so long.
    std::chrono::milliseconds settled = std::chrono::milliseconds(2000);
    /// The same for a file of which is known that somebody has changed it and not closed it.
    std::chrono::milliseconds settled_open = std::chrono::minutes(1);
    /// How often to look through all folders. Between, only the files that the kernel names are looked at;
    /// where it says nothing, this is how long a new image stays unseen.
    std::chrono::milliseconds look_every = std::chrono::milliseconds(500);
    FolderEvents::Source events = FolderEvents::Source::kernel;
  };

  /// The folder need not be there yet.
  CameraFolder(std::filesystem::path folder, const Options& options);

  /// The next image (.jpg .jpeg .tif .tiff .seq .csq .fff, in any case of letters; nothing hidden, nothing
  /// empty). Waits for one, at most so long.
  [[nodiscard]] std::optional<std::filesystem::path> next(std::chrono::milliseconds longest);
  /// Takes all that is there now for given.
  void passOver();
  /// An image that next() gave could not be used, because it vanished with the card or could not be read: it
  /// is given again when it is back, or has changed.
  void putBack(const std::filesystem::path& image);

 private:
  using Clock = std::chrono::steady_clock;
  struct State {
    std::uintmax_t size = 0;
    std::filesystem::file_time_type changed;
    friend bool operator==(const State& a, const State& b) = default;
  };
  struct Given {
    State state;
    std::uint64_t digest = 0;  ///< of its content
  };
  struct Waiting {
    State state;
    Clock::time_point since;                    ///< it stands still
    std::optional<FolderEvents::Change> heard;  ///< last, from the kernel
  };
  using WaitingImages = std::map<std::string, Waiting>;

  /// What the kernel says until a file is whole, or until then.
  [[nodiscard]] FolderEvents::Changes hear(Clock::time_point end);
  /// Looks at these files, or through all folders when that is due or nothing else is to be done.
  void look(const FolderEvents::Changes& changes);
  void lookThroughAll(const FolderEvents::Changes& changes);
  void lookAt(const std::filesystem::path& file, const FolderEvents::Changes& changes,
              WaitingImages& still_there);
  /// nullopt where there is no file, or an empty one.
  [[nodiscard]] static std::optional<State> stateOf(const std::filesystem::path& file);
  /// Its path in the folder.
  [[nodiscard]] std::string nameOf(const std::filesystem::path& file) const;
  [[nodiscard]] bool isReady(const Waiting& image) const;
  /// Of those that are ready the next by order; the end when none is.
  [[nodiscard]] WaitingImages::iterator nextReady();
  /// Whether this content was not given under this name before.
  bool give(const std::string& name, const State& state);

  std::filesystem::path folder_;
  Options options_;
  FolderEvents events_;
  Clock::time_point looked_;            ///< last
  Clock::time_point looked_through_;    ///< all folders, last
  WaitingImages waiting_;               ///< by path in the folder
  std::map<std::string, Given> given_;  ///< likewise
};

}  // namespace thermovox
