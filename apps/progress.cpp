#include "apps/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace thermovox {

Progress::Progress(std::string title, Time begin, std::optional<Time> end)
    : title_(std::move(title)), begin_(begin), end_(end), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (on_terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::at(Time stamp) {
  if (!on_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_drawn_ < std::chrono::milliseconds(100)) return;
  last_drawn_ = now;
  const double seconds = toSeconds(stamp - begin_);
  if (end_ && *end_ > begin_) {
    const double share = std::clamp(seconds / toSeconds(*end_ - begin_), 0.0, 1.0);
    constexpr int width = 30;
    const std::string bar(static_cast<std::size_t>(share * width), '#');
    std::fprintf(stderr, "\r\033[K%s [%-*s] %3.0f %%  %.1f s", title_.c_str(), width, bar.c_str(),
                 100.0 * share, seconds);
  } else {
    std::fprintf(stderr, "\r\033[K%s  %.1f s of data", title_.c_str(), seconds);
  }
}

}  // namespace thermovox
