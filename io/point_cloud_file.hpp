#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "projection/laser/multi_beam.hpp"

namespace thermovox {

/// Reads the points of a PCD (ascii, binary, binary_compressed) or PLY file (ascii, binary of both byte
/// orders), in the file's order; which of the two it is tells its content. Of the fields, of whatever numeric
/// types, it takes x y z (metres), intensity and time (seconds after the cloud's stamp) and passes over the
/// rest; `scalar_intensity` and `scalar_time`, CloudCompare's names for them, do as well. Throws DataError
/// naming the file when it cannot be read, is truncated, lies about its size, or lacks x, y or z. `named_by`
/// says who wants the file, for the message when it does not exist.
[[nodiscard]] std::vector<CloudPoint> readCloudPoints(const std::filesystem::path& file,
                                                      std::string_view named_by = {});

/// The same from the bytes of such a file; `name` stands for it in messages.
[[nodiscard]] std::vector<CloudPoint> parseCloudPoints(std::string_view bytes, const std::string& name);

}  // namespace thermovox
