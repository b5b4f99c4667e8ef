#include "projection/time.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <system_error>

namespace thermovox {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
/// Half of the 64 bits, a date in 2115: the other half is room to add offsets, limits and delays.
constexpr std::int64_t kLargestNanoseconds = 4'600'000'000'000'000'000;

bool isDigits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// "+09" and the like; a power that nobody can mean is cut to one that is as far out of range.
std::optional<int> parseExponent(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || !isDigits(text)) return std::nullopt;
  constexpr int kFurthest = 100'000;
  int value = 0;
  const std::errc error = std::from_chars(text.data(), text.data() + text.size(), value).ec;
  if (error != std::errc{} || value > kFurthest) value = kFurthest;
  return negative ? -value : value;
}

/// The number whose digits are `whole` and `fraction`, times 10^(exponent + 9), rounded half up.
std::optional<std::int64_t> scaledToNanoseconds(std::string_view whole, std::string_view fraction,
                                                int exponent) {
  const auto count = static_cast<std::ptrdiff_t>(whole.size() + fraction.size());
  const auto digit = [&](std::ptrdiff_t i) {
    const auto n = static_cast<std::size_t>(i);
    return (n < whole.size() ? whole[n] : fraction[n - whole.size()]) - '0';
  };
  const std::ptrdiff_t end =
      static_cast<std::ptrdiff_t>(whole.size()) + exponent + 9;  // of the whole nanoseconds
  std::int64_t nanoseconds = 0;
  for (std::ptrdiff_t i = 0; i < end && (i < count || nanoseconds != 0); ++i) {
    const int next = i < count ? digit(i) : 0;
    if (nanoseconds > (kLargestNanoseconds - next) / 10) return std::nullopt;
    nanoseconds = nanoseconds * 10 + next;
  }
  const bool up = end >= 0 && end < count && digit(end) >= 5;
  return nanoseconds + (up ? 1 : 0);
}

/// A number without sign.
std::optional<std::int64_t> parseMagnitude(std::string_view text) {
  const std::size_t e = text.find_first_of("eE");
  const std::optional<int> exponent = e == std::string_view::npos ? 0 : parseExponent(text.substr(e + 1));
  const std::string_view mantissa = text.substr(0, e);
  const std::size_t point = mantissa.find('.');
  const std::string_view whole = mantissa.substr(0, point);
  const std::string_view fraction =
      point == std::string_view::npos ? std::string_view() : mantissa.substr(point + 1);
  if (!exponent || whole.size() + fraction.size() == 0 || !isDigits(whole) || !isDigits(fraction))
    return std::nullopt;
  return scaledToNanoseconds(whole, fraction, *exponent);
}

}  // namespace

Duration durationFromSeconds(double seconds) {
  return Duration(std::llround(seconds * 1e9));
}

std::optional<Time> parseTime(std::string_view text) {
  const bool negative = text.starts_with('-');
  const std::optional<std::int64_t> nanoseconds = parseMagnitude(negative ? text.substr(1) : text);
  if (!nanoseconds) return std::nullopt;
  return Time(Duration(negative ? -*nanoseconds : *nanoseconds));
}

std::string formatTime(Time time) {
  const std::int64_t nanoseconds = time.time_since_epoch().count();
  const std::uint64_t magnitude =
      nanoseconds < 0 ? 0 - static_cast<std::uint64_t>(nanoseconds) : static_cast<std::uint64_t>(nanoseconds);
  std::array<char, 40> text{};
  const int length = std::snprintf(text.data(), text.size(), "%s%llu.%09llu", nanoseconds < 0 ? "-" : "",
                                   static_cast<unsigned long long>(magnitude / kNanosecondsPerSecond),
                                   static_cast<unsigned long long>(magnitude % kNanosecondsPerSecond));
  return {text.data(), static_cast<std::size_t>(length)};
}

}  // namespace thermovox
