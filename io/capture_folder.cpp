#include "io/capture_folder.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "io/board_yaml.hpp"
#include "io/csv.hpp"
#include "io/description_file.hpp"
#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "io/rig_file.hpp"
#include "io/yaml_map.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestCapturesFile = std::size_t{1} << 20;  // bytes; it has a few lines
constexpr std::size_t kLeastColumns = 3;                            // without a header

/// A column of captures.csv and where its file goes.
struct Column {
  std::string_view name;
  std::optional<fs::path> CaptureFiles::*file;
};
constexpr std::array<Column, 5> kColumns{{{"thermal", &CaptureFiles::thermal},
                                          {"visible", &CaptureFiles::visible},
                                          {"laser", &CaptureFiles::laser},
                                          {"thermal_corners", &CaptureFiles::thermal_corners},
                                          {"visible_corners", &CaptureFiles::visible_corners}}};
constexpr std::string_view kExpected = "thermal,visible,laser[,thermal_corners[,visible_corners]]";

const Column* columnOf(std::string_view name) {
  const auto column =
      std::find_if(kColumns.begin(), kColumns.end(), [&](const Column& one) { return one.name == name; });
  return column == kColumns.end() ? nullptr : column;
}

/// Rows of captures.csv, one after the other.
class CaptureRows {
 public:
  CaptureRows(CsvReader csv, fs::path folder) : csv_(std::move(csv)), folder_(std::move(folder)) {}

  std::optional<CaptureFiles> next() {
    if (!csv_.next()) return std::nullopt;
    if (columns_.empty()) {
      columns_ = columnsOf(csv_.fields());
      if (headed_ && !csv_.next()) return std::nullopt;
    }
    return capture();
  }

 private:
  [[nodiscard]] DataError fault(const std::string& what) const {
    return DataError(csv_.place() + ": " + what);
  }

  /// By the first row, which is a header if it has the name of any column in it.
  std::vector<Column> columnsOf(std::span<const std::string_view> fields) {
    headed_ =
        std::any_of(fields.begin(), fields.end(), [](std::string_view field) { return columnOf(field); });
    if (!headed_) {
      if (fields.size() < kLeastColumns || fields.size() > kColumns.size()) {
        throw fault("has " + std::to_string(fields.size()) + " field(s), expected " + std::string(kExpected));
      }
      return {kColumns.begin(), kColumns.begin() + static_cast<std::ptrdiff_t>(fields.size())};
    }
    std::vector<Column> columns;
    for (const std::string_view field : fields) {
      const Column* column = columnOf(field);
      if (column == nullptr)
        throw fault("unknown column " + inQuotes(field) + ", expected " + std::string(kExpected));
      if (std::count(fields.begin(), fields.end(), field) > 1)
        throw fault("column " + inQuotes(field) + " is given twice, expected once");
      columns.push_back(*column);
    }
    return columns;
  }

  CaptureFiles capture() {
    const auto& fields = csv_.fields();
    if (fields.size() != columns_.size()) {
      throw fault("has " + std::to_string(fields.size()) + " field(s), expected " +
                  std::to_string(columns_.size()) + ", one for each column");
    }
    CaptureFiles files{.place = csv_.place()};
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!fields[i].empty()) files.*columns_[i].file = once(fields[i]);
    }
    if (!files.thermal && !files.visible && !files.laser && !files.thermal_corners && !files.visible_corners)
      throw fault("names no file, expected at least one of thermal, visible and laser");
    if ((files.thermal_corners && !files.thermal) || (files.visible_corners && !files.visible))
      throw fault("names corners without their image, expected both");
    for (const std::string_view column : {"visible", "thermal", "laser"}) {
      const std::string_view written = fieldOf(column);
      if (!written.empty()) files.name = written;
    }
    return files;
  }

  /// The field of a column; empty where there is no such column.
  [[nodiscard]] std::string_view fieldOf(std::string_view name) const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i].name == name) return csv_.fields()[i];
    }
    return {};
  }

  /// The path of a file that no other field names.
  fs::path once(std::string_view written) {
    if (written.find('\0') != std::string_view::npos) throw fault("the name of the file is damaged");
    fs::path file = folder_ / written;
    const auto [named, first] = named_by_.emplace(file.lexically_normal(), csv_.place());
    if (!first) {
      throw fault("names " + inQuotes(written) + ", which " + named->second +
                  " names too, expected each file once");
    }
    return file;
  }

  CsvReader csv_;
  fs::path folder_;
  std::vector<Column> columns_;
  bool headed_ = false;
  std::map<fs::path, std::string> named_by_;
};

void checkThere(const CaptureFiles& capture) {
  for (const Column& column : kColumns) {
    if (const std::optional<fs::path>& file = capture.*column.file)
      static_cast<void>(openInput(*file, capture.place + ", " + std::string(column.name)));
  }
}

}  // namespace

CapturesFile parseCapturesFile(const std::string& text, const std::string& file_name) {
  const YamlMap map = YamlMap::parse(text, file_name);
  map.allow({"name", "captures", "rig", "board"});
  return {.name = map.plainName("name"),
          .captures = map.text("captures"),
          .rig = map.text("rig"),
          .board = readBoard(map.map("board"))};
}

std::vector<CaptureFiles> readCaptureList(std::unique_ptr<std::istream> list, const std::string& name,
                                          const fs::path& folder) {
  CaptureRows rows(CsvReader(std::move(list), name, CsvReader::Header::keep), folder);
  std::vector<CaptureFiles> captures;
  while (std::optional<CaptureFiles> capture = rows.next()) captures.push_back(std::move(*capture));
  if (captures.empty()) throw DataError(name + ": lists no capture, expected one a row");
  return captures;
}

CaptureFolder openCaptures(const fs::path& folder) {
  const fs::path file = descriptionFile(folder, "captures.yaml", "captures");
  const CapturesFile said = parseCapturesFile(readWhole(file, "", kLargestCapturesFile), file.string());
  CaptureFolder opened{.name = said.name, .board = said.board, .folder = file.parent_path()};
  const auto wanted = [&](const std::string& written, const char* key) {
    return std::make_unique<std::ifstream>(openInput(opened.folder / written, file.string() + ", " + key));
  };
  opened.rig_file = opened.folder / said.rig;
  static_cast<void>(wanted(said.rig, "rig"));
  opened.rig = readRig(opened.rig_file);
  const fs::path list = opened.folder / said.captures;
  opened.captures = readCaptureList(wanted(said.captures, "captures"), list.string(), opened.folder);
  for (const CaptureFiles& capture : opened.captures) checkThere(capture);
  return opened;
}

}  // namespace thermovox
