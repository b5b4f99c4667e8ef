#include "io/board_yaml.hpp"

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr int kFewest = 3;  // corners or circles in a row, and rows
constexpr int kMost = 64;
constexpr double kLargestSquare = 2.0;   // metres
constexpr double kLargestPlate = 200.0;  // metres; more than a pattern of the most and largest squares
constexpr double kRounding = 1e-6;       // metres

ConfigError fault(const YamlMap& map, std::string_view key, const std::string& what) {
  return ConfigError(map.place(key) + ": " + what);
}

CalibrationBoard::Pattern readPattern(const YamlMap& map) {
  const std::string pattern = map.text("pattern");
  if (pattern == "chessboard") return CalibrationBoard::Pattern::chessboard;
  if (pattern == "asymmetric_circles") return CalibrationBoard::Pattern::asymmetric_circles;
  throw fault(map, "pattern", "found " + inQuotes(pattern) + ", expected chessboard or asymmetric_circles");
}

int count(const YamlMap& map, std::string_view key, double number) {
  if (!(number >= kFewest && number <= kMost && number == std::floor(number))) {
    throw fault(map, key,
                "found " + exactText(number) + ", expected whole numbers from " + std::to_string(kFewest) +
                    " to " + std::to_string(kMost));
  }
  return static_cast<int>(number);
}

void readCounts(const YamlMap& map, CalibrationBoard& board) {
  const bool circles = board.pattern == CalibrationBoard::Pattern::asymmetric_circles;
  if (map.has("circles") && !circles)
    throw fault(map, "circles", "is given for a chessboard, expected inner_corners");
  if (map.has("circles") && map.has("inner_corners"))
    throw fault(map, "circles", "is given beside inner_corners, expected one or the other");
  const std::string_view key = map.has("circles") ? "circles" : "inner_corners";
  const std::vector<double> counts = map.numbers(key, 2);
  board.columns = count(map, key, counts[0]);
  board.rows = count(map, key, counts[1]);
}

/// From one end of the pattern to the other, metres: squares of a chessboard, middles of circles.
Eigen::Vector2d patternSize(const CalibrationBoard& board) {
  if (board.pattern == CalibrationBoard::Pattern::chessboard)
    return board.square * Eigen::Vector2d(board.columns + 1, board.rows + 1);
  return board.square * Eigen::Vector2d(2 * board.columns - 1, board.rows - 1);
}

double edge(const YamlMap& map, std::string_view key, double pattern) {
  const double length = map.number(key);
  if (!(length >= pattern - kRounding && length <= kLargestPlate)) {
    throw fault(map, key,
                "is " + exactText(length) + " m, expected a plate from the size of its pattern, " +
                    exactText(pattern) + " m, to " + exactText(kLargestPlate) + " m");
  }
  return length;
}

/// Leaves the plate unknown where the mapping does not say.
void readPlate(const YamlMap& map, CalibrationBoard& board) {
  const Eigen::Vector2d pattern = patternSize(board);
  const bool edges = map.has("width") || map.has("height");
  if (edges && map.has("margin"))
    throw fault(map, "margin", "is given beside width and height, expected one or the other");
  if (edges) {
    board.width = edge(map, "width", pattern.x());
    board.height = edge(map, "height", pattern.y());
  } else if (const std::optional<double> margin = map.numberIf("margin")) {
    if (!(*margin >= 0.0 && *margin <= kLargestSquare))
      throw fault(map, "margin", "is " + exactText(*margin) + " m, expected 0 to 2 m");
    board.width = pattern.x() + 2.0 * *margin;
    board.height = pattern.y() + 2.0 * *margin;
  }
}

}  // namespace

CalibrationBoard readBoard(const YamlMap& map) {
  map.allow({"pattern", "inner_corners", "circles", "square", "margin", "width", "height"});
  CalibrationBoard board{.pattern = readPattern(map)};
  readCounts(map, board);
  board.square = map.number("square");
  if (!(board.square > 0.0 && board.square <= kLargestSquare)) {
    throw fault(map, "square", "is " + exactText(board.square) + " m, expected more than 0 and at most 2 m");
  }
  readPlate(map, board);
  if (board.pattern == CalibrationBoard::Pattern::chessboard && board.columns == board.rows &&
      std::abs(board.width - board.height) > kRounding) {
    throw fault(map, "",
                "has as many rows as columns on a plate of " + exactText(board.width) + " x " +
                    exactText(board.height) +
                    " m, which cannot be told apart when turned by 90 degrees, expected a square plate or "
                    "another grid");
  }
  return board;
}

}  // namespace thermovox
