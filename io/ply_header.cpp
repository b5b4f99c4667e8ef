#include <array>
#include <charconv>

#include "io/cloud_layout.hpp"
#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

struct PlyType {
  std::string_view name;
  NumberKind kind;
  std::size_t size;
};
constexpr std::array kTypes{
    PlyType{"char", NumberKind::with_sign, 1},      PlyType{"int8", NumberKind::with_sign, 1},
    PlyType{"uchar", NumberKind::without_sign, 1},  PlyType{"uint8", NumberKind::without_sign, 1},
    PlyType{"short", NumberKind::with_sign, 2},     PlyType{"int16", NumberKind::with_sign, 2},
    PlyType{"ushort", NumberKind::without_sign, 2}, PlyType{"uint16", NumberKind::without_sign, 2},
    PlyType{"int", NumberKind::with_sign, 4},       PlyType{"int32", NumberKind::with_sign, 4},
    PlyType{"uint", NumberKind::without_sign, 4},   PlyType{"uint32", NumberKind::without_sign, 4},
    PlyType{"float", NumberKind::floating, 4},      PlyType{"float32", NumberKind::floating, 4},
    PlyType{"double", NumberKind::floating, 8},     PlyType{"float64", NumberKind::floating, 8},
};

/// Reads a PLY header. The points are the element `vertex`; others may follow it but not come first.
class PlyHeader {
 public:
  PlyHeader(std::string_view bytes, const std::string& name) : lines_(bytes), name_(name) {}

  CloudLayout read() {
    if (!lines_.next() || lines_.words().size() != 1 || lines_.words()[0] != "ply") {
      throw DataError(name_ + ": does not begin with 'ply', expected a PLY file");
    }
    while (lines_.next()) {
      if (lines_.words().empty()) continue;
      if (lines_.words().front() == "end_header") return finish();
      readLine();
    }
    throw DataError(name_ + ": the header ends without end_header, expected a PLY file");
  }

 private:
  void readLine() {
    const auto& words = lines_.words();
    const std::string_view key = words.front();
    if (key == "format") {
      readFormat();
    } else if (key == "element") {
      readElement();
    } else if (key == "property") {
      if (element_ == Element::none) fail(key, "an element before its properties");
      if (element_ == Element::vertex) readProperty();
    } else if (key != "comment" && key != "obj_info") {
      fail(key, "a key of a PLY header");
    }
  }

  void readFormat() {
    const auto& words = lines_.words();
    const std::string_view format = words.size() == 3 && words[2] == "1.0" ? words[1] : "";
    if (format == "ascii") {
      layout_.encoding = CloudEncoding::text;
    } else if (format == "binary_little_endian") {
      layout_.encoding = CloudEncoding::little_endian;
    } else if (format == "binary_big_endian") {
      layout_.encoding = CloudEncoding::big_endian;
    } else {
      fail(words.size() > 1 ? words[1] : "", "format ascii, binary_little_endian or binary_big_endian 1.0");
    }
    has_format_ = true;
  }

  void readElement() {
    const auto& words = lines_.words();
    if (words.size() != 3) fail(words.front(), "a name and a number behind it");
    if (words[1] != "vertex") {
      if (element_ == Element::none) fail(words[1], "the element vertex first");
      element_ = Element::other;
      return;
    }
    if (element_ != Element::none) fail(words[1], "the element vertex once");
    element_ = Element::vertex;
    const auto [end, error] =
        std::from_chars(words[2].data(), words[2].data() + words[2].size(), layout_.points);
    if (error != std::errc{} || end != words[2].data() + words[2].size()) fail(words[2], "a whole number");
  }

  void readProperty() {
    const auto& words = lines_.words();
    if (words.size() != 3) fail(words.size() > 1 ? words[1] : "", "a type and a name of a single number");
    for (const PlyType& type : kTypes) {
      if (type.name == words[1]) {
        layout_.fields.push_back({.name = std::string(words[2]), .kind = type.kind, .size = type.size});
        return;
      }
    }
    fail(words[1], "a type of PLY");
  }

  CloudLayout finish() {
    if (!has_format_ || element_ == Element::none) {
      throw DataError(name_ + ": the header lacks the format or the element vertex, expected a PLY file");
    }
    layout_.body_offset = lines_.offset();
    layout_.body_line = lines_.number() + 1;
    return layout_;
  }

  [[noreturn]] void fail(std::string_view found, const std::string& expected) const {
    throw DataError(name_ + ":" + std::to_string(lines_.number()) + ": found " + inQuotes(found) +
                    ", expected " + expected);
  }

  enum class Element { none, vertex, other };

  HeaderLines lines_;
  const std::string& name_;
  CloudLayout layout_;
  bool has_format_ = false;
  Element element_ = Element::none;
};

}  // namespace

CloudLayout parsePlyHeader(std::string_view bytes, const std::string& name) {
  return PlyHeader(bytes, name).read();
}

}  // namespace thermovox
