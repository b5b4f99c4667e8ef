#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace thermovox {

static_assert(std::endian::native == std::endian::little, "packed integers are kept little endian");

/// An unsigned integer in as few bytes as its range needs, at any address.
template <std::size_t kBytes>
class PackedInteger {
  static_assert(kBytes >= 1 && kBytes <= 8);

 public:
  /// The largest value that fits.
  static constexpr std::uint64_t kMax = ~std::uint64_t{0} >> (64 - 8 * kBytes);

  PackedInteger() = default;
  PackedInteger(std::uint64_t value) { std::memcpy(bytes_.data(), &value, kBytes); }  // NOLINT: a number
  operator std::uint64_t() const {                                                    // NOLINT: a number
    std::uint64_t value = 0;
    std::memcpy(&value, bytes_.data(), kBytes);
    return value;
  }
  PackedInteger& operator+=(std::uint64_t addend) { return *this = *this + addend; }

 private:
  std::array<std::uint8_t, kBytes> bytes_{};
};

}  // namespace thermovox
