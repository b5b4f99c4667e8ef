#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "tests/support/recordings.hpp"

namespace thermovox::test {

/// The example in io/README.md that begins so, to the end of its block.
[[nodiscard]] inline std::string readmeExample(std::string_view beginning) {
  const std::string readme = bytesOf(std::filesystem::path(THERMOVOX_SOURCE_DIR) / "io" / "README.md");
  const std::size_t begin = readme.find(beginning);
  EXPECT_NE(begin, std::string::npos) << beginning;
  return begin == std::string::npos ? std::string() : readme.substr(begin, readme.find("```", begin) - begin);
}

/// The text with its first `old_part` replaced.
[[nodiscard]] inline std::string replaced(std::string text, std::string_view old_part,
                                          std::string_view new_part) {
  const std::size_t place = text.find(old_part);
  EXPECT_NE(place, std::string::npos) << old_part;
  return place == std::string::npos ? text : text.replace(place, old_part.size(), new_part);
}

}  // namespace thermovox::test
