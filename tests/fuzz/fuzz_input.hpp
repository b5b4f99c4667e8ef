#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>

#include "projection/error.hpp"

namespace thermovox::fuzz {

/// The fuzzer's bytes as the text that the readers take.
[[nodiscard]] inline std::string textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

[[nodiscard]] inline std::unique_ptr<std::istream> streamOf(const std::uint8_t* data, std::size_t size) {
  return std::make_unique<std::istringstream>(textOf(data, size));
}

/// Runs a reader. It may refuse the input with one of the project's own errors; any other exception is a
/// fault of the reader and ends the program.
template <typename Reader>
void read(Reader&& reader) {
  try {
    reader();
  } catch (const Error&) {
  }
}

/// Ends the program where a reader accepts what it must not or loses what it read.
inline void require(bool holds) {
  if (!holds) __builtin_trap();
}

}  // namespace thermovox::fuzz
