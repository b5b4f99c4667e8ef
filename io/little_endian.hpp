#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace thermovox {

namespace detail {
template <std::size_t bytes>
using UnsignedOf =
    std::conditional_t<bytes == 1, std::uint8_t,
                       std::conditional_t<bytes == 2, std::uint16_t,
                                          std::conditional_t<bytes == 4, std::uint32_t, std::uint64_t>>>;
}  // namespace detail

/// Appends a number, least significant byte first, whatever the machine. Floats as their IEEE 754 bits.
template <typename T>
void appendLittleEndian(std::string& bytes, T number) {
  static_assert(std::is_arithmetic_v<T>);
  auto bits = std::bit_cast<detail::UnsignedOf<sizeof(T)>>(number);
  char text[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i)
    text[i] = static_cast<char>((std::uint64_t{bits} >> (8 * i)) & 0xFF);
  bytes.append(text, sizeof(T));
}

/// Reads numbers that appendLittleEndian wrote.
class LittleEndianReader {
 public:
  explicit LittleEndianReader(std::string_view bytes) : bytes_(bytes) {}

  /// The next number; nullopt, and nothing more to read, when fewer bytes are left.
  template <typename T>
  [[nodiscard]] std::optional<T> next() {
    static_assert(std::is_arithmetic_v<T>);
    if (bytes_.size() < sizeof(T)) {
      bytes_ = {};
      return std::nullopt;
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bits |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << (8 * i);
    }
    bytes_.remove_prefix(sizeof(T));
    return std::bit_cast<T>(static_cast<detail::UnsignedOf<sizeof(T)>>(bits));
  }
  /// The next `count` bytes as they are; nullopt when fewer are left.
  [[nodiscard]] std::optional<std::string_view> nextBytes(std::size_t count) {
    if (bytes_.size() < count) return std::nullopt;
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

}  // namespace thermovox
