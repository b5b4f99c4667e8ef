#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace thermovox {

static_assert(std::endian::native == std::endian::little, "packed integers are kept little endian");

/// An unsigned integer in as few bytes as its range needs, at any address.
template <std::size_t kBytes>
class PackedInteger {
  static_assert(std::popcount(kBytes) <= 2 && kBytes >= 1 && kBytes <= 8);

 public:
  /// The largest value that fits.
  static constexpr std::uint64_t kMax = ~std::uint64_t{0} >> (64 - 8 * kBytes);

  PackedInteger() = default;
  PackedInteger(std::uint64_t value) {  // NOLINT: a number
    store<0, kFirst>(value);
    if constexpr (kSecond > 0) store<kFirst, kSecond>(value >> (8 * kFirst));
  }
  operator std::uint64_t() const {  // NOLINT: a number
    std::uint64_t value = load<0, kFirst>();
    if constexpr (kSecond > 0) value |= load<kFirst, kSecond>() << (8 * kFirst);
    return value;
  }
  PackedInteger& operator+=(std::uint64_t addend) { return *this = *this + addend; }

 private:
  // In two whole words, never through a wider one: a processor waits for bytes that were written singly.
  static constexpr std::size_t kFirst = std::bit_floor(kBytes);
  static constexpr std::size_t kSecond = kBytes - kFirst;
  template <std::size_t kWord>
  using Word =
      std::conditional_t<kWord == 1, std::uint8_t,
                         std::conditional_t<kWord == 2, std::uint16_t,
                                            std::conditional_t<kWord == 4, std::uint32_t, std::uint64_t>>>;

  template <std::size_t kAt, std::size_t kWord>
  void store(std::uint64_t value) {
    const auto word = static_cast<Word<kWord>>(value);
    std::memcpy(bytes_.data() + kAt, &word, kWord);
  }
  template <std::size_t kAt, std::size_t kWord>
  [[nodiscard]] std::uint64_t load() const {
    Word<kWord> word;
    std::memcpy(&word, bytes_.data() + kAt, kWord);
    return word;
  }

  std::array<std::uint8_t, kBytes> bytes_{};
};

}  // namespace thermovox
