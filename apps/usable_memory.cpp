#include "apps/usable_memory.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace thermovox {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// The number in the file; no limit where there is no file, or another word ("max").
std::uint64_t limitIn(const fs::path& file) {
  std::ifstream stream(file);
  std::uint64_t bytes = 0;
  return stream >> bytes ? bytes : kNoLimit;
}

/// Of the group and those above it. Within a container the list may name the group as the host sees it, which
/// is not there; then the root is the container's.
std::uint64_t leastUpTo(const fs::path& root, const fs::path& group, const char* file) {
  std::uint64_t least = limitIn(root / file);
  fs::path place = root;
  for (const fs::path& part : group.relative_path()) {
    if (part == "..") break;  // outside of what is mounted here
    place /= part;
    least = std::min(least, limitIn(place / file));
  }
  return least;
}

}  // namespace

std::uint64_t groupMemory(const fs::path& list, const fs::path& root) {
  std::uint64_t least = kNoLimit;
  std::ifstream stream(list);
  for (std::string line; std::getline(stream, line);) {  // ID:CONTROLLERS:GROUP
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    std::string controllers(1, ',');
    controllers.append(line, first + 1, second - first - 1).push_back(',');
    const fs::path group = line.substr(second + 1);
    if (controllers == ",,") {
      least = std::min(least, leastUpTo(root, group, "memory.max"));
    } else if (controllers.find(",memory,") != std::string::npos) {
      least = std::min(least, leastUpTo(root / "memory", group, "memory.limit_in_bytes"));
    }
  }
  return least;
}

std::uint64_t usableMemory() {
  const auto physical = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                        static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE));
  return std::min(physical, groupMemory("/proc/self/cgroup", "/sys/fs/cgroup"));
}

}  // namespace thermovox
