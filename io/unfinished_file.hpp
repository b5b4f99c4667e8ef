#pragma once

#include <filesystem>

namespace thermovox {

/// A file in the making, beside the one that it is to become: NAME.<host>-<process>-<n>.unfinished. Who makes
/// it holds a lock on it (flock), which ends with the process however that ends: what nobody on its host
/// holds was left by a process that was killed. Other hosts that share the folder need not see the lock
/// (sshfs, NFS with local locks); they take a file for left when besides it has not changed for an hour. So
/// does everybody with one that could not be locked, whose <host> begins with an @. On file systems without
/// such locks nothing is ever taken for left.
class UnfinishedFile {
 public:
  /// Removes what killed processes left beside `file`, and creates an empty one. Throws DataError naming
  /// `shown` when that cannot be.
  UnfinishedFile(const std::filesystem::path& file, const std::filesystem::path& shown);
  /// Removes it, unless it was kept.
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// It has another name by now, and is held no more.
  void keep();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;  ///< that has the lock
};

}  // namespace thermovox
