#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace thermovox {

/// Which byte of a number comes first: the least significant (little) or the most significant (big).
enum class ByteOrder { little, big };

/// The number at a place of a record; nullopt where the record ends before it.
template <typename T>
[[nodiscard]] std::optional<T> numberAt(std::span<const std::byte> bytes, std::size_t offset,
                                        ByteOrder order) {
  static_assert(std::is_arithmetic_v<T>);
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) return std::nullopt;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t place = order == ByteOrder::big ? i : sizeof(T) - 1 - i;
    bits = bits << 8 | std::to_integer<std::uint64_t>(bytes[offset + place]);
  }
  if constexpr (sizeof(T) == 4 && std::is_floating_point_v<T>) {
    return std::bit_cast<T>(static_cast<std::uint32_t>(bits));
  } else if constexpr (std::is_floating_point_v<T>) {
    return std::bit_cast<T>(bits);
  } else {
    return static_cast<T>(bits);
  }
}

/// The bytes as characters.
[[nodiscard]] inline std::string_view charactersOf(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[nodiscard]] inline bool beginsWith(std::span<const std::byte> bytes, std::string_view magic) {
  return charactersOf(bytes).starts_with(magic);
}

/// A text of at most `length` bytes that ends at its first zero; trailing blanks, and what is no printable
/// ASCII, are left out. Empty where the record ends before it.
[[nodiscard]] inline std::string textAt(std::span<const std::byte> bytes, std::size_t offset,
                                        std::size_t length) {
  std::string text;
  if (offset >= bytes.size()) return text;
  for (const char c : charactersOf(bytes.subspan(offset)).substr(0, length)) {
    if (c == '\0') break;
    if (c >= ' ' && c <= '~') text += c;
  }
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

}  // namespace thermovox
