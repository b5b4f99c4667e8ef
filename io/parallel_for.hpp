#pragma once

#include <cstddef>
#include <functional>

namespace thermovox {

/// Calls work(0) .. work(count - 1), each once, on up to `threads` threads (0: one for each processor), the
/// caller's among them. The calls share nothing but what they are made to share. When some throw, the error
/// of the smallest index is thrown on, once all are done.
void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace thermovox
