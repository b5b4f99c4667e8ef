#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace thermovox {

/// Opens a file for reading, as bytes. `named_by` says who wants it ("mission.yaml, thermal"; may be empty)
/// and stands in the message. Throws DataError when the file does not exist, is no regular file (a folder, a
/// pipe) or cannot be read.
[[nodiscard]] std::ifstream openInput(const std::filesystem::path& file, std::string_view named_by = {});

/// The bytes of a whole file. Throws DataError as openInput does, and when the file is larger than
/// `largest` bytes.
[[nodiscard]] std::string readWhole(const std::filesystem::path& file, std::string_view named_by = {},
                                    std::size_t largest = std::size_t{1} << 40);

}  // namespace thermovox
