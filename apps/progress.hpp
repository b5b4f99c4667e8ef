#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "projection/time.hpp"

namespace thermovox {

/// A progress line on stderr, only where stderr is a terminal; it wipes itself at the end.
class Progress {
 public:
  /// `end` is where the stamps will arrive; without it only the time covered is shown.
  Progress(std::string title, Time begin, std::optional<Time> end);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(Time stamp);

 private:
  std::string title_;
  Time begin_;
  std::optional<Time> end_;
  bool on_terminal_;
  std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace thermovox
