#pragma once

#include <array>
#include <cstdint>

namespace thermovox {

/// Wide enough for any product below. (ISO C++ has no 128-bit integer; GCC and Clang do, on 64-bit targets.)
__extension__ typedef unsigned __int128 Uint128;

/// A sum of non-negative integers, exact up to 2^96, in 12 bytes that need only 4-byte alignment.
struct Sum96 {
  std::array<std::uint32_t, 3> words{};  ///< least significant first

  [[nodiscard]] Uint128 value() const {
    return (static_cast<Uint128>(words[2]) << 64) | (static_cast<Uint128>(words[1]) << 32) | words[0];
  }
  Sum96& operator+=(Uint128 addend) {
    const Uint128 sum = value() + addend;
    words = {static_cast<std::uint32_t>(sum), static_cast<std::uint32_t>(sum >> 32),
             static_cast<std::uint32_t>(sum >> 64)};
    return *this;
  }
  friend bool operator==(const Sum96&, const Sum96&) = default;
};

}  // namespace thermovox
