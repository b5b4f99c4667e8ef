#include <charconv>
#include <functional>
#include <optional>

#include "io/cloud_layout.hpp"
#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

using Words = std::vector<std::string_view>;
constexpr std::uint64_t kMostNumbersOfField = 100'000;

/// Gathers the lines of a PCD header (versions 0.5 to 0.7) in whatever order they come.
class PcdHeader {
 public:
  PcdHeader(std::string_view bytes, const std::string& name) : lines_(bytes), name_(name) {}

  CloudLayout read() {
    while (lines_.next()) {
      const Words& words = lines_.words();
      if (words.empty() || words.front().starts_with('#')) continue;
      if (words.front() == "DATA") return finish();
      readLine(words);
    }
    throw DataError(name_ + ": the header ends without DATA, expected a PCD file");
  }

 private:
  void readLine(const Words& words) {
    const std::string_view key = words.front();
    if (key == "FIELDS" || key == "COLUMNS") {
      for (std::size_t i = 1; i < words.size(); ++i)
        layout_.fields.push_back({.name = std::string(words[i])});
    } else if (key == "SIZE") {
      eachField(words, [this](CloudField& field, std::string_view word) {
        field.size = whole(word);
        if (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8)
          fail(word, "1, 2, 4 or 8 bytes");
      });
      has_size_ = true;
    } else if (key == "TYPE") {
      eachField(words, [this](CloudField& field, std::string_view word) { field.kind = kind(word); });
      has_type_ = true;
    } else if (key == "COUNT") {
      eachField(words, [this](CloudField& field, std::string_view word) {
        field.count = whole(word);
        if (field.count == 0 || field.count > kMostNumbersOfField) fail(word, "1 to 100000 numbers");
      });
    } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
      if (words.size() != 2) fail(key, "one number behind it");
      (key == "WIDTH" ? width_ : key == "HEIGHT" ? height_ : points_) = whole(words[1]);
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      fail(key, "a key of a PCD header");
    }
  }

  CloudLayout finish() {
    const Words& words = lines_.words();
    const std::string_view data = words.size() == 2 ? words[1] : "";
    if (data == "ascii") {
      layout_.encoding = CloudEncoding::text;
    } else if (data == "binary") {
      layout_.encoding = CloudEncoding::little_endian;
    } else if (data == "binary_compressed") {
      layout_.encoding = CloudEncoding::compressed;
    } else {
      fail(data, "DATA ascii, binary or binary_compressed");
    }
    if (layout_.fields.empty() || !has_size_ || !has_type_) {
      throw DataError(name_ + ": the header lacks FIELDS, SIZE or TYPE, expected a PCD file");
    }
    layout_.points = pointCount();
    layout_.body_offset = lines_.offset();
    layout_.body_line = lines_.number() + 1;
    return layout_;
  }

  std::uint64_t pointCount() const {
    std::optional<std::uint64_t> grid;
    if (width_) {
      const std::uint64_t height = height_.value_or(1);
      if (height != 0 && *width_ > UINT64_MAX / height) throw DataError(name_ + ": WIDTH x HEIGHT is absurd");
      grid = *width_ * height;
    }
    if (points_ && grid && *points_ != *grid) {
      throw DataError(name_ + ": POINTS is " + std::to_string(*points_) +
                      ", expected WIDTH x HEIGHT = " + std::to_string(*grid));
    }
    if (!points_ && !grid) throw DataError(name_ + ": the header lacks POINTS, expected a PCD file");
    return points_ ? *points_ : *grid;
  }

  void eachField(const Words& words, const std::function<void(CloudField&, std::string_view)>& set) {
    if (words.size() != layout_.fields.size() + 1) {
      fail(words.front(), "one entry for each of the " + std::to_string(layout_.fields.size()) + " FIELDS");
    }
    for (std::size_t i = 0; i < layout_.fields.size(); ++i) set(layout_.fields[i], words[i + 1]);
  }

  std::uint64_t whole(std::string_view word) const {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || end != word.data() + word.size()) fail(word, "a whole number");
    return number;
  }

  NumberKind kind(std::string_view word) const {
    if (word == "F") return NumberKind::floating;
    if (word == "I") return NumberKind::with_sign;
    if (word != "U") fail(word, "TYPE F, I or U");
    return NumberKind::without_sign;
  }

  [[noreturn]] void fail(std::string_view found, const std::string& expected) const {
    throw DataError(name_ + ":" + std::to_string(lines_.number()) + ": found " + inQuotes(found) +
                    ", expected " + expected);
  }

  HeaderLines lines_;
  const std::string& name_;
  CloudLayout layout_;
  bool has_size_ = false;
  bool has_type_ = false;
  std::optional<std::uint64_t> width_;
  std::optional<std::uint64_t> height_;
  std::optional<std::uint64_t> points_;
};

}  // namespace

CloudLayout parsePcdHeader(std::string_view bytes, const std::string& name) {
  return PcdHeader(bytes, name).read();
}

}  // namespace thermovox
