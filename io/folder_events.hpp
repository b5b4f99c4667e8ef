#pragma once

#include <chrono>
#include <filesystem>
#include <map>

namespace thermovox {

/// Wakes whoever waits for changes in some folders (inotify). Where the kernel does not hear of changes, as
/// on memory cards, network and user-space file systems, it only waits.
class FolderEvents {
 public:
  enum class Source {
    kernel,  ///< inotify, where it works
    none,    ///< nothing: look again when the time is over
  };
  /// What happened last to a file.
  enum class Change {
    written,  ///< closed after writing, or moved here whole
    touched,  ///< changed, and not closed since
  };
  using Changes = std::map<std::filesystem::path, Change>;

  explicit FolderEvents(Source source);
  ~FolderEvents();
  FolderEvents(const FolderEvents&) = delete;
  FolderEvents& operator=(const FolderEvents&) = delete;

  /// Changes in this folder count from now on. Does nothing where they do already, or cannot. To be called
  /// again after a file system was mounted there.
  void watch(const std::filesystem::path& folder);
  /// Waits for a change, at most so long; the files that had one. There may be others: the kernel drops
  /// events when there are too many.
  [[nodiscard]] Changes wait(std::chrono::milliseconds longest);

 private:
  /// Adds what the kernel has to say; false when that is nothing more.
  bool read(Changes& changes);

  int descriptor_ = -1;                           ///< of inotify; below zero without it
  std::map<int, std::filesystem::path> folders_;  ///< by watch
};

}  // namespace thermovox
