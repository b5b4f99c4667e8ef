#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace thermovox {

/// The number of threads to use where so many are asked for; 0 asks for one for each processor.
[[nodiscard]] inline int threadsToUse(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Calls work(0) .. work(workers - 1) at the same time, work(0) here, and waits for all. The first exception,
/// by the number of the worker, is thrown on.
template <typename Work>
void runInParallel(int workers, Work&& work) {
  if (workers <= 1) return work(0);
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(workers));
  const auto guarded = [&](int worker) {
    try {
      work(worker);
    } catch (...) {
      failures[static_cast<std::size_t>(worker)] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int worker = 1; worker < workers; ++worker) others.emplace_back(guarded, worker);
    guarded(0);
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace thermovox
