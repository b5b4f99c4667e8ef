#include "io/parallel_for.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace thermovox {
namespace {

TEST(ParallelFor, DoesEveryItemOnceOnAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 8}) {
    std::vector<std::atomic<int>> done(1000);
    parallelFor(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
  }
  parallelFor(0, 4, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, ThrowsTheErrorOfTheFirstItem) {
  for (const int threads : {1, 4}) {
    try {
      parallelFor(100, threads, [](std::size_t i) {
        if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
      });
      ADD_FAILURE() << "threw nothing";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "7");
    }
  }
}

}  // namespace
}  // namespace thermovox
