#include "projection/time.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

namespace thermovox {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr double kLargestSeconds = 9.2e9;  // 64-bit nanoseconds end at 9.22e9 s

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// "123.456" without sign or exponent; nullopt for anything else.
std::optional<std::int64_t> parsePlainDecimal(std::string_view text) {
  std::int64_t whole = 0;
  std::size_t i = 0;
  for (; i < text.size() && isDigit(text[i]); ++i) {
    whole = whole * 10 + (text[i] - '0');
    if (whole > static_cast<std::int64_t>(kLargestSeconds)) return std::nullopt;
  }
  const std::size_t whole_digits = i;
  std::size_t fraction_digits = 0;
  std::int64_t fraction = 0;
  std::int64_t unit = kNanosecondsPerSecond;
  if (i < text.size() && text[i] == '.') {
    for (++i; i < text.size() && isDigit(text[i]); ++i, ++fraction_digits) {
      if (unit > 1) {
        unit /= 10;
        fraction += unit * (text[i] - '0');
      } else if (fraction_digits == 9 && text[i] >= '5') {
        ++fraction;  // the tenth decimal rounds, the rest cannot matter
      }
    }
  }
  if (i != text.size() || whole_digits + fraction_digits == 0) return std::nullopt;
  return whole * kNanosecondsPerSecond + fraction;
}

std::optional<std::int64_t> parseThroughDouble(std::string_view text) {
  double seconds = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(seconds))
    return std::nullopt;
  if (std::abs(seconds) > kLargestSeconds) return std::nullopt;
  return std::llround(seconds * 1e9);
}

}  // namespace

Duration durationFromSeconds(double seconds) {
  return Duration(std::llround(seconds * 1e9));
}

std::optional<Time> parseTime(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  const std::string_view magnitude = negative ? text.substr(1) : text;
  if (magnitude.empty() || !(isDigit(magnitude.front()) || magnitude.front() == '.')) return std::nullopt;
  std::optional<std::int64_t> nanoseconds = parsePlainDecimal(magnitude);
  if (!nanoseconds && magnitude.find_first_of("eE") != std::string_view::npos) {
    nanoseconds = parseThroughDouble(magnitude);
  }
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
