#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "projection/cpu_level.hpp"

namespace thermovox {

// The exponential and the logarithm from sums, products and shifts alone: unlike those of the C library,
// which differ in the last bit from processor to processor, they give the same bits everywhere and can be
// computed for many numbers at a time. Both are good to 4e-16 of their result.

namespace portable {

inline constexpr double kLn2High = 0x1.62e42feep-1;  ///< ln 2, its upper 32 bits: exact in products with k
inline constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
/// A double of this exponent holds whole numbers in its lowest bits.
inline constexpr double kWhole = 0x1.8p52;

/// The polynomial, spelt out at compile time: a loop within a loop would not become vector instructions.
template <std::size_t k = 0, std::size_t kCount>
[[nodiscard]] THERMOVOX_INLINE_LOOP double horner(const std::array<double, kCount>& coefficients, double x) {
  if constexpr (k + 1 == kCount) {
    return coefficients[k];
  } else {
    return horner<k + 1>(coefficients, x) * x + coefficients[k];
  }
}

/// 1 / k!: the series of e^r, for |r| <= ln 2 / 2.
inline constexpr std::array<double, 14> kExpSeries = [] {
  std::array<double, 14> series{1.0};
  for (std::size_t k = 1; k < series.size(); ++k) series[k] = series[k - 1] / static_cast<double>(k);
  return series;
}();
/// 2 / (2k + 1): the series of ln((1 + s) / (1 - s)) / s in s^2, for |s| <= 0.172.
inline constexpr std::array<double, 11> kLogSeries = [] {
  std::array<double, 11> series{};
  for (std::size_t k = 0; k < series.size(); ++k) series[k] = 2.0 / static_cast<double>(2 * k + 1);
  return series;
}();

}  // namespace portable

/// e^x; 0 below -708 and infinite above 709.
[[nodiscard]] THERMOVOX_INLINE_LOOP double portableExp(double x) {
  const double shifted = x * 0x1.71547652b82fep0 + portable::kWhole;  // x / ln 2
  const double k = shifted - portable::kWhole;
  const double r = (x - k * portable::kLn2High) - k * portable::kLn2Low;
  const double power = std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023) << 52);
  const double value = portable::horner(portable::kExpSeries, r) * power;
  const double not_above = x > 709.0 ? std::numeric_limits<double>::infinity() : value;
  return x < -708.0 ? 0.0 : not_above;
}

/// The natural logarithm of a positive number; NaN for every other, and for what is below 2.3e-308.
[[nodiscard]] THERMOVOX_INLINE_LOOP double portableLog(double x) {
  constexpr std::uint64_t kOne = std::bit_cast<std::uint64_t>(1.0);
  constexpr std::uint64_t kRootHalf = 0x3fe6a09e667f3bcd;
  // x = 2^k m, m from sqrt(1/2) to sqrt(2)
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) + (kOne - kRootHalf);
  const double m = std::bit_cast<double>((bits & 0x000fffffffffffff) + kRootHalf);
  const double k = std::bit_cast<double>((bits >> 52) | 0x4330000000000000) - (0x1p52 + 1023.0);
  const double s = (m - 1.0) / (m + 1.0);
  const double log_m = s * portable::horner(portable::kLogSeries, s * s);
  const double value = k * portable::kLn2High + (log_m + k * portable::kLn2Low);
  const bool counts = x >= std::numeric_limits<double>::min() && x <= std::numeric_limits<double>::max();
  return counts ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace thermovox
