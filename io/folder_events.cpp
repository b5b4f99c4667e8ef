#include "io/folder_events.hpp"

#include <linux/magic.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <thread>

namespace thermovox {
namespace {

constexpr std::uint32_t kChanges = IN_CREATE | IN_MODIFY | IN_CLOSE_WRITE | IN_MOVED_TO;

/// Whether others than this kernel write to the file system: the camera itself, another host, a daemon.
bool isDeaf(const std::filesystem::path& folder) {
  constexpr std::array<std::uint64_t, 6> deaf{MSDOS_SUPER_MAGIC, 0x2011BAB0 /* exFAT */, FUSE_SUPER_MAGIC,
                                              NFS_SUPER_MAGIC,   SMB2_SUPER_MAGIC,       V9FS_MAGIC};
  struct statfs file_system {};
  if (::statfs(folder.c_str(), &file_system) != 0) return true;
  const auto kind = static_cast<std::uint32_t>(file_system.f_type);
  return std::find(deaf.begin(), deaf.end(), kind) != deaf.end();
}

}  // namespace

FolderEvents::FolderEvents(Source source)
    : descriptor_(source == Source::kernel ? ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK) : -1) {}

FolderEvents::~FolderEvents() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void FolderEvents::watch(const std::filesystem::path& folder) {
  if (descriptor_ < 0 || isDeaf(folder)) return;
  // Of a folder that is watched already the kernel gives the same number again.
  const int number = ::inotify_add_watch(descriptor_, folder.c_str(), kChanges | IN_MOVE_SELF | IN_ONLYDIR);
  if (number >= 0) folders_[number] = folder;
}

FolderEvents::Changes FolderEvents::wait(std::chrono::milliseconds longest) {
  Changes changes;
  if (descriptor_ < 0) {
    std::this_thread::sleep_for(longest);
    return changes;
  }
  pollfd ready{descriptor_, POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(longest.count())) > 0) {
    while (read(changes)) {
    }
  }
  return changes;
}

bool FolderEvents::read(Changes& changes) {
  alignas(inotify_event) std::array<char, 16384> buffer;
  const ssize_t got = ::read(descriptor_, buffer.data(), buffer.size());
  for (std::size_t place = 0; got > 0 && place < static_cast<std::size_t>(got);) {
    inotify_event event{};
    std::memcpy(&event, buffer.data() + place, sizeof event);
    const char* name = buffer.data() + place + sizeof event;
    place += sizeof event + event.len;
    const auto folder = folders_.find(event.wd);
    if (folder == folders_.end()) continue;  // lost events, or of a folder that is gone
    if ((event.mask & IN_IGNORED) != 0) {
      folders_.erase(folder);
    } else if ((event.mask & IN_MOVE_SELF) != 0) {
      ::inotify_rm_watch(descriptor_, event.wd);  // it is not where it was
    } else if (event.len > 0 && (event.mask & IN_ISDIR) == 0) {
      const bool whole = (event.mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0;
      changes[folder->second / name] = whole ? Change::written : Change::touched;
    }
  }
  return got > 0;
}

}  // namespace thermovox
