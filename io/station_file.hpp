#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "io/sqlite.hpp"

namespace thermovox {

/// How long to wait for other processes that write a station, and what to call once when that begins.
struct StationPatience {
  std::optional<std::chrono::milliseconds> most = std::chrono::seconds(30);  ///< none: without end
  std::function<void()> begins;
};

/// Opens a station for reading. Throws DataError naming the file when it is no station, or one of a version
/// that this program does not know. What is read through the one object is of one file, whatever takes its
/// place meanwhile.
[[nodiscard]] SqlDatabase openStation(const std::filesystem::path& path);

/// Whether an SQLite database lies under this name, which lockStation can lock: a station, as a rule.
[[nodiscard]] bool isDatabase(const std::filesystem::path& path);

/// Keeps other processes from writing the station until the object goes, which is open on the file that lies
/// there then: whoever waited for one that has been replaced goes on to the new one. Throws DataError when
/// others have not finished in time, counted from the call.
[[nodiscard]] std::unique_ptr<SqlDatabase> lockStation(const std::filesystem::path& path,
                                                       const StationPatience& patience);

}  // namespace thermovox
