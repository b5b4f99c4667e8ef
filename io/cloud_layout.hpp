#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace thermovox {

/// The type of the numbers of a cloud's field: integers with or without sign, or IEEE floats.
enum class NumberKind { with_sign, without_sign, floating };

/// One field of the points of a PCD or PLY file.
struct CloudField {
  std::string name;
  NumberKind kind = NumberKind::floating;
  std::size_t size = 4;   ///< bytes of one number: 1, 2, 4 or 8
  std::size_t count = 1;  ///< numbers a point
};

enum class CloudEncoding {
  text,           ///< a line a point
  little_endian,  ///< point by point
  big_endian,     ///< point by point
  compressed,     ///< PCD's binary_compressed: LZF over field by field, little endian
};

/// What the header of a point cloud says.
struct CloudLayout {
  std::vector<CloudField> fields;
  std::uint64_t points = 0;
  CloudEncoding encoding = CloudEncoding::text;
  std::size_t body_offset = 0;  ///< bytes from the file's start to the points
  std::size_t body_line = 1;    ///< line number of the points' first line, where they are text
};

/// Read the headers. `name` stands for the file in messages. Throw DataError naming file and line for what is
/// not of the format; whether the points are all there is for the caller to see.
[[nodiscard]] CloudLayout parsePcdHeader(std::string_view bytes, const std::string& name);
[[nodiscard]] CloudLayout parsePlyHeader(std::string_view bytes, const std::string& name);

/// Cuts a text into lines and knows where it is.
class HeaderLines {
 public:
  explicit HeaderLines(std::string_view bytes) : bytes_(bytes) {}

  /// The words of the next line; false at the end.
  [[nodiscard]] bool next();
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  [[nodiscard]] std::size_t offset() const { return offset_; }  ///< of the first byte behind the line
  [[nodiscard]] std::size_t number() const { return number_; }  ///< of the line, from 1

 private:
  std::string_view bytes_;
  std::vector<std::string_view> words_;
  std::size_t offset_ = 0;
  std::size_t number_ = 0;
};

/// Cuts a line at its blanks.
void splitWords(std::string_view line, std::vector<std::string_view>& words);

}  // namespace thermovox
