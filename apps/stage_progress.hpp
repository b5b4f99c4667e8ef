#pragma once

#include <chrono>
#include <string>

namespace thermovox {

/// A progress line on stderr for work in stages, only where stderr is a terminal; it wipes itself at the end.
class StageProgress {
 public:
  StageProgress();
  ~StageProgress();
  StageProgress(const StageProgress&) = delete;
  StageProgress& operator=(const StageProgress&) = delete;

  /// What is being done, and how much of it is: 0 to 1.
  void at(const std::string& stage, double done);

 private:
  bool on_terminal_;
  std::string stage_;
  std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace thermovox
