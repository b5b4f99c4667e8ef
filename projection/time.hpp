#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace thermovox {

using Duration = std::chrono::duration<std::int64_t, std::nano>;

/// The one clock that all stamps of a mission are of: Unix time where the recorder knew it. The tag keeps
/// stamps apart from the clocks of this computer.
struct SensorClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<SensorClock>;
  static constexpr bool is_steady = false;
};

/// 64-bit nanoseconds since the epoch. A double holds Unix time only to 0.24 us, hence never one here.
using Time = SensorClock::time_point;

/// Seconds as a duration, rounded to the nanosecond; for intervals (offsets, increments), not for stamps.
[[nodiscard]] Duration durationFromSeconds(double seconds);
[[nodiscard]] constexpr double toSeconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}
/// Unix seconds as a double: exact to about a quarter of a microsecond, for outputs that have no better type.
/// Whole seconds apart: the nanoseconds together have more digits than a double.
[[nodiscard]] constexpr double toUnixSeconds(Time time) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch());
  return static_cast<double>(whole.count()) + toSeconds(time.time_since_epoch() - whole);
}

/// Reads decimal seconds ("1700000000.199999809", "32.9", "1.7e9") to the nanosecond without passing through
/// a double. nullopt when the text is not one finite number or leaves the range of 64-bit nanoseconds.
[[nodiscard]] std::optional<Time> parseTime(std::string_view text);

/// Decimal seconds with 9 decimals.
[[nodiscard]] std::string formatTime(Time time);

}  // namespace thermovox
