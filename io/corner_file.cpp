#include "io/corner_file.hpp"

#include <fstream>
#include <utility>

#include "io/csv.hpp"
#include "io/input_file.hpp"
#include "projection/error.hpp"

namespace thermovox {

std::vector<Eigen::Vector2d> readCorners(std::unique_ptr<std::istream> stream, const std::string& name,
                                         const CalibrationBoard& board) {
  const std::size_t expected = static_cast<std::size_t>(board.columns) * static_cast<std::size_t>(board.rows);
  CsvReader csv(std::move(stream), name);
  std::vector<Eigen::Vector2d> corners;
  std::size_t count = 0;
  while (csv.next()) {
    if (csv.fields().size() != 2) {
      throw DataError(csv.place() + ": has " + std::to_string(csv.fields().size()) +
                      " field(s), expected u,v");
    }
    const Eigen::Vector2d pixel(csv.number(0), csv.number(1));
    if (!pixel.allFinite()) throw DataError(csv.place() + ": is not finite, expected a pixel");
    if (++count <= expected) corners.push_back(pixel);  // the rest is only counted
  }
  if (count != expected) {
    throw DataError(name + ": has " + std::to_string(count) + " corner(s), expected " +
                    std::to_string(expected) + ", " + std::to_string(board.columns) + " in each of " +
                    std::to_string(board.rows) + " rows");
  }
  return corners;
}

std::vector<Eigen::Vector2d> readCorners(const std::filesystem::path& file, const CalibrationBoard& board,
                                         std::string_view named_by) {
  return readCorners(std::make_unique<std::ifstream>(openInput(file, named_by)), file.string(), board);
}

}  // namespace thermovox
