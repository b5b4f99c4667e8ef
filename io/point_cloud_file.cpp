#include "io/point_cloud_file.hpp"

#include <pcl/io/lzf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "io/cloud_layout.hpp"
#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the decoding below swaps bytes for big endian only");

/// Which of a cloud's fields are read, in this order.
enum Wanted { kX, kY, kZ, kIntensity, kTime, kWanted };
constexpr std::array<std::string_view, kWanted> kNames{"x", "y", "z", "intensity", "time"};

/// A PCD file begins with a comment, most often "# .PCD v0.7", or with one of its first keys.
constexpr std::array<std::string_view, 4> kPcdBeginnings{"#", "VERSION", "FIELDS", "COLUMNS"};

/// Where a wanted number lies: in the body of a binary file at offset + i * stride, in a text in a column.
struct Column {
  NumberKind kind = NumberKind::floating;
  std::size_t size = 0;
  std::size_t offset = 0;
  std::size_t stride = 0;
  std::size_t word = 0;
};
using Columns = std::array<std::optional<Column>, kWanted>;

std::size_t pointSize(const CloudLayout& layout) {
  std::size_t size = 0;
  for (const CloudField& field : layout.fields) size += field.size * field.count;
  return size;
}

std::size_t wordCount(const CloudLayout& layout) {
  std::size_t count = 0;
  for (const CloudField& field : layout.fields) count += field.count;
  return count;
}

std::optional<Wanted> wantedField(std::string_view name) {
  constexpr std::string_view kCloudComparePrefix = "scalar_";
  if (name.starts_with(kCloudComparePrefix)) {
    name.remove_prefix(kCloudComparePrefix.size());
    if (name.size() == 1) return std::nullopt;  // scalar_x is no coordinate
  }
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Wanted>(found - kNames.begin());
}

Columns columnsOf(const CloudLayout& layout, const std::string& name) {
  Columns columns;
  const bool by_field = layout.encoding == CloudEncoding::compressed;
  const std::size_t point_size = pointSize(layout);
  std::size_t offset = 0;
  std::size_t word = 0;
  for (const CloudField& field : layout.fields) {
    const std::optional<Wanted> wanted = wantedField(field.name);
    if (wanted && !columns[*wanted]) {
      columns[*wanted] = Column{field.kind, field.size, by_field ? offset * layout.points : offset,
                                by_field ? field.size * field.count : point_size, word};
    }
    offset += field.size * field.count;
    word += field.count;
  }
  if (!columns[kX] || !columns[kY] || !columns[kZ]) {
    std::string fields;
    for (const CloudField& field : layout.fields) fields += (fields.empty() ? "" : " ") + field.name;
    throw DataError(name + ": has the fields " + inQuotes(fields) + ", expected x y z among them");
  }
  return columns;
}

CloudPoint pointFrom(const std::array<double, kWanted>& values) {
  return {{static_cast<float>(values[kX]), static_cast<float>(values[kY]), static_cast<float>(values[kZ])},
          static_cast<float>(values[kIntensity]),
          values[kTime]};
}

/// What a wanted number is where the cloud has no such field.
constexpr std::array<double, kWanted> kAbsent{0.0, 0.0, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0};

template <typename Number>
double load(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return static_cast<double>(number);
}

double decode(NumberKind kind, std::size_t size, const char* bytes) {
  switch (kind) {
    case NumberKind::floating:
      return size == 4 ? load<float>(bytes) : load<double>(bytes);
    case NumberKind::with_sign:
      return size == 1   ? load<std::int8_t>(bytes)
             : size == 2 ? load<std::int16_t>(bytes)
             : size == 4 ? load<std::int32_t>(bytes)
                         : load<std::int64_t>(bytes);
    case NumberKind::without_sign:
      break;
  }
  return size == 1   ? load<std::uint8_t>(bytes)
         : size == 2 ? load<std::uint16_t>(bytes)
         : size == 4 ? load<std::uint32_t>(bytes)
                     : load<std::uint64_t>(bytes);
}

/// Points of a body that holds them all.
std::vector<CloudPoint> decodeBinary(std::string_view body, const CloudLayout& layout,
                                     const Columns& columns) {
  std::vector<CloudPoint> points;
  points.reserve(layout.points);
  for (std::size_t i = 0; i < layout.points; ++i) {
    std::array<double, kWanted> values = kAbsent;
    for (std::size_t w = 0; w < kWanted; ++w) {
      if (!columns[w]) continue;
      const Column& column = *columns[w];
      std::array<char, 8> bytes{};
      std::copy_n(body.data() + column.offset + i * column.stride, column.size, bytes.begin());
      if (layout.encoding == CloudEncoding::big_endian)
        std::reverse(bytes.begin(), bytes.begin() + column.size);
      values[w] = decode(column.kind, column.size, bytes.data());
    }
    points.push_back(pointFrom(values));
  }
  return points;
}

std::vector<CloudPoint> readBinary(std::string_view body, const CloudLayout& layout,
                                   const std::string& name) {
  const Columns columns = columnsOf(layout, name);
  if (layout.points > body.size() / pointSize(layout)) {
    throw DataError(name + ": is truncated: holds " + std::to_string(body.size() / pointSize(layout)) +
                    " points, expected " + std::to_string(layout.points));
  }
  return decodeBinary(body, layout, columns);
}

/// The fields of a compressed PCD, one after the other. The body is two 32-bit sizes and an LZF stream.
std::string decompress(std::string_view body, const CloudLayout& layout, const std::string& name) {
  constexpr std::size_t kSizes = 8;
  constexpr std::uint64_t kTightestPacking = 100;  // LZF makes at most 264 bytes of 3
  std::uint32_t packed = 0;
  std::uint32_t unpacked = 0;
  if (body.size() < kSizes) throw DataError(name + ": is truncated: its compressed points are missing");
  std::memcpy(&packed, body.data(), sizeof packed);
  std::memcpy(&unpacked, body.data() + sizeof packed, sizeof unpacked);
  if (packed > body.size() - kSizes) {
    throw DataError(name + ": is truncated: holds " + std::to_string(body.size() - kSizes) +
                    " bytes of compressed points, expected " + std::to_string(packed));
  }
  const std::uint64_t point_size = pointSize(layout);
  const bool sizes_fit = unpacked / point_size == layout.points && unpacked % point_size == 0;
  if (!sizes_fit || unpacked > packed * kTightestPacking) {
    throw DataError(name + ": claims " + std::to_string(layout.points) + " points of " +
                    std::to_string(point_size) + " bytes, " + std::to_string(unpacked) + " unpacked and " +
                    std::to_string(packed) + " packed, expected sizes that fit together");
  }
  std::string fields(unpacked, '\0');
  if (unpacked > 0 && pcl::lzfDecompress(body.data() + kSizes, packed, fields.data(), unpacked) != unpacked) {
    throw DataError(name + ": its compressed points are damaged");
  }
  return fields;
}

CloudPoint pointFromWords(const std::vector<std::string_view>& words, const Columns& columns,
                          const std::string& name, std::size_t line) {
  std::array<double, kWanted> values = kAbsent;
  for (std::size_t w = 0; w < kWanted; ++w) {
    if (!columns[w]) continue;
    const std::string_view word = words[columns[w]->word];
    const std::optional<double> number = parseNumber(word);
    if (!number) {
      throw DataError(name + ":" + std::to_string(line) + ": found " + inQuotes(word) +
                      ", expected a number");
    }
    values[w] = *number;
  }
  return pointFrom(values);
}

std::vector<CloudPoint> readText(std::string_view body, const CloudLayout& layout, const std::string& name) {
  const Columns columns = columnsOf(layout, name);
  const std::size_t expected = wordCount(layout);
  std::vector<CloudPoint> points;
  // A word and a blank are two bytes: a header that claims more than that allows gets no memory for it.
  points.reserve(std::min<std::uint64_t>(layout.points, body.size() / (2 * expected) + 1));
  HeaderLines lines(body);
  while (points.size() < layout.points && lines.next()) {
    if (lines.words().empty()) continue;
    const std::size_t line = layout.body_line + lines.number() - 1;
    if (lines.words().size() != expected) {
      throw DataError(name + ":" + std::to_string(line) + ": has " + std::to_string(lines.words().size()) +
                      " numbers, expected " + std::to_string(expected));
    }
    points.push_back(pointFromWords(lines.words(), columns, name, line));
  }
  if (points.size() < layout.points) {
    throw DataError(name + ": is truncated: holds " + std::to_string(points.size()) + " points, expected " +
                    std::to_string(layout.points));
  }
  return points;
}

/// Floats have 4 or 8 bytes; PCD's syntax allows others.
void checkFloats(const CloudLayout& layout, const std::string& name) {
  for (const CloudField& field : layout.fields) {
    if (field.kind == NumberKind::floating && field.size < 4) {
      throw DataError(name + ": field " + inQuotes(field.name) + " is a float of " +
                      std::to_string(field.size) + " bytes, expected 4 or 8");
    }
  }
}

}  // namespace

std::vector<CloudPoint> parseCloudPoints(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw DataError(name + ": is empty, expected a PCD or PLY file");
  const bool ply = bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
  const bool pcd = std::any_of(kPcdBeginnings.begin(), kPcdBeginnings.end(),
                               [bytes](std::string_view beginning) { return bytes.starts_with(beginning); });
  if (!ply && !pcd) throw DataError(name + ": is neither a PCD nor a PLY file");
  const CloudLayout layout = ply ? parsePlyHeader(bytes, name) : parsePcdHeader(bytes, name);
  checkFloats(layout, name);
  const std::string_view body = bytes.substr(layout.body_offset);
  switch (layout.encoding) {
    case CloudEncoding::text:
      return readText(body, layout, name);
    case CloudEncoding::compressed:
      return decodeBinary(decompress(body, layout, name), layout, columnsOf(layout, name));
    case CloudEncoding::little_endian:
    case CloudEncoding::big_endian:
      break;
  }
  return readBinary(body, layout, name);
}

std::vector<CloudPoint> readCloudPoints(const std::filesystem::path& file, std::string_view named_by) {
  return parseCloudPoints(readWhole(file, named_by), file.string());
}

}  // namespace thermovox
