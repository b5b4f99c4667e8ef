#pragma once

#include <cmath>

namespace thermovox {

/// The chance that a chi-square of so many degrees of freedom is larger: exact, by the recurrence in steps of
/// two degrees (Abramowitz and Stegun 26.4.4 and 26.4.5).
[[nodiscard]] inline double chiSquareTail(double chi_square, int freedom) {
  if (!(chi_square > 0.0) || freedom < 1) return 1.0;
  const bool odd = freedom % 2 == 1;
  double tail = odd ? std::erfc(std::sqrt(0.5 * chi_square)) : std::exp(-0.5 * chi_square);
  double term = odd ? std::sqrt(2.0 * chi_square / M_PI) * std::exp(-0.5 * chi_square)
                    : 0.5 * chi_square * std::exp(-0.5 * chi_square);
  for (int k = odd ? 1 : 2; k < freedom; k += 2) {
    tail += term;
    term *= chi_square / (k + 2);
  }
  return tail;
}

}  // namespace thermovox
