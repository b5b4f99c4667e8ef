#include "projection/cpu_level.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

namespace thermovox {
namespace {

THERMOVOX_INLINE_LOOP int sumLoop(const std::array<int, 100>& numbers) {
  int sum = 0;
  for (const int n : numbers) sum += n;
  return sum;
}
THERMOVOX_TARGET_AVX2 int sumAvx2(const std::array<int, 100>& numbers) {
  return sumLoop(numbers);
}
THERMOVOX_TARGET_AVX512 int sumAvx512(const std::array<int, 100>& numbers) {
  return sumLoop(numbers);
}

TEST(CpuLevel, RunsWhatIsCompiledForItAndBelow) {
  std::array<int, 100> numbers{};
  std::iota(numbers.begin(), numbers.end(), 1);
  EXPECT_EQ(sumLoop(numbers), 5050);
  if (cpuLevel() >= CpuLevel::avx2) {
    EXPECT_EQ(sumAvx2(numbers), 5050);
  }
  if (cpuLevel() >= CpuLevel::avx512) {
    EXPECT_EQ(sumAvx512(numbers), 5050);
  }
}

TEST(CpuLevel, HasANameThatLeadsBack) {
  for (const CpuLevel level : {CpuLevel::baseline, CpuLevel::avx2, CpuLevel::avx512})
    EXPECT_EQ(cpuLevelNamed(nameOf(level)), level);
  EXPECT_EQ(cpuLevelNamed("sse9"), std::nullopt);
}

}  // namespace
}  // namespace thermovox
