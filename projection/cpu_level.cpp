#include "projection/cpu_level.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace thermovox {
namespace {

constexpr std::array<std::string_view, 3> kNames{"baseline", "avx2", "avx512"};

CpuLevel levelOfProcessor() {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                    __builtin_cpu_supports("popcnt");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (avx512) return CpuLevel::avx512;
  if (avx2) return CpuLevel::avx2;
#endif
  return CpuLevel::baseline;
}

CpuLevel levelToUse() {
  const CpuLevel best = levelOfProcessor();
  const char* wish = std::getenv("THERMOVOX_CPU_LEVEL");
  return wish == nullptr ? best : std::min(best, cpuLevelNamed(wish).value_or(best));
}

}  // namespace

CpuLevel cpuLevel() {
  static const CpuLevel level = levelToUse();
  return level;
}

std::optional<CpuLevel> cpuLevelNamed(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<CpuLevel>(found - kNames.begin());
}

std::string_view nameOf(CpuLevel level) {
  return kNames[static_cast<std::size_t>(level)];
}

}  // namespace thermovox
