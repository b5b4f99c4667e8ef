#include "io/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

#include "mapping/parallel.hpp"

namespace thermovox {

void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  const auto wanted = static_cast<std::size_t>(threadsToUse(threads));
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  runInParallel(static_cast<int>(std::min(wanted, count)), [&](int) { run(); });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace thermovox
