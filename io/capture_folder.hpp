#pragma once

#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "projection/calibration_board.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// What a captures.yaml says; the files are as written, relative to its folder.
struct CapturesFile {
  std::string name;
  std::string captures;  ///< the list of them, captures.csv
  std::string rig;       ///< the first guess
  CalibrationBoard board;
};

/// Reads the text of a captures.yaml; `file_name` stands for it in messages. Throws ConfigError naming the
/// key that is missing, unknown or impossible.
[[nodiscard]] CapturesFile parseCapturesFile(const std::string& text, const std::string& file_name);

/// The files of one capture: the still board as the sensors saw it. At least one sensor did.
struct CaptureFiles {
  std::string name;  ///< of its first file as written: the laser's, else the thermal, else the visible one
  std::optional<std::filesystem::path> thermal;
  std::optional<std::filesystem::path> visible;
  std::optional<std::filesystem::path> laser;
  std::optional<std::filesystem::path> thermal_corners;  ///< clicked by hand, see readCorners(); of `thermal`
  std::optional<std::filesystem::path> visible_corners;  ///< the same, of `visible`
  std::string place;                                     ///< "captures.csv:3", for messages
};

/// Reads a captures.csv, a capture a row: `thermal,visible,laser[,thermal_corners[,visible_corners]]`, in the
/// order of its header or, without one, in this. Fields may be empty, but not of a whole row. `name` stands
/// for the list in messages, `folder` is what its files are relative to. Throws DataError naming file and
/// line, also for a file that is named twice, corners without their image, and a list without a capture.
[[nodiscard]] std::vector<CaptureFiles> readCaptureList(std::unique_ptr<std::istream> list,
                                                        const std::string& name,
                                                        const std::filesystem::path& folder);

/// Captures of a calibration board.
struct CaptureFolder {
  std::string name;
  CalibrationBoard board;
  Rig rig;  ///< the first guess
  std::filesystem::path rig_file;
  std::filesystem::path folder;  ///< of captures.yaml
  std::vector<CaptureFiles> captures;
};

/// Opens a folder of captures: the folder or its captures.yaml. All files are there, but have not been read;
/// whether the rig has the sensors that they are of is not looked at. Throws ConfigError or DataError, naming
/// the file and who refers to it, for what is missing, damaged or does not fit together.
[[nodiscard]] CaptureFolder openCaptures(const std::filesystem::path& folder);

}  // namespace thermovox
