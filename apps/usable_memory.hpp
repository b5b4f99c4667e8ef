#pragma once

#include <cstdint>
#include <filesystem>

namespace thermovox {

/// Memory that this process may use, bytes: that of the machine, or what its control group and those above it
/// leave it (a container, a batch job), whichever is least.
[[nodiscard]] std::uint64_t usableMemory();

/// The least limit of a process' control groups, bytes; the largest number where there is none. `list` is its
/// /proc/PID/cgroup and `root` where the groups are mounted, /sys/fs/cgroup. Reads version 2 (memory.max) and
/// version 1 (memory/.../memory.limit_in_bytes).
[[nodiscard]] std::uint64_t groupMemory(const std::filesystem::path& list, const std::filesystem::path& root);

}  // namespace thermovox
