#include "apps/stage_progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace thermovox {

StageProgress::StageProgress() : on_terminal_(::isatty(STDERR_FILENO) == 1) {}

StageProgress::~StageProgress() {
  if (on_terminal_) std::fputs("\r\033[K", stderr);
}

void StageProgress::at(const std::string& stage, double done) {
  if (!on_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (stage == stage_ && now - last_drawn_ < std::chrono::milliseconds(100)) return;
  stage_ = stage;
  last_drawn_ = now;
  constexpr int width = 30;
  const double share = std::clamp(done, 0.0, 1.0);
  const std::string bar(static_cast<std::size_t>(share * width), '#');
  std::fprintf(stderr, "\r\033[K[%-*s] %3.0f %%  %s", width, bar.c_str(), 100.0 * share, stage.c_str());
  std::fflush(stderr);
}

}  // namespace thermovox
