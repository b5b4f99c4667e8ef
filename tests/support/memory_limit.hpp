#pragma once

#include <sys/resource.h>

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

namespace thermovox::test {

/// While it lives, this process may take no more than so many bytes of memory beside what it has: what asks
/// for more gets std::bad_alloc.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::uint64_t more_bytes) {
    if (getrlimit(RLIMIT_AS, &before_) != 0) throw std::runtime_error("getrlimit failed");
    rlimit limit = before_;
    limit.rlim_cur = taken() + more_bytes;
    if (setrlimit(RLIMIT_AS, &limit) != 0) throw std::runtime_error("setrlimit failed");
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  /// Bytes of this process's address space.
  static std::uint64_t taken() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
      std::uint64_t kilobytes = 0;
      if (word == "VmSize:" && status >> kilobytes) return 1024 * kilobytes;
    }
    throw std::runtime_error("/proc/self/status: holds no VmSize");
  }

  rlimit before_{};
};

}  // namespace thermovox::test
