#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mapping/hotspot.hpp"
#include "projection/time.hpp"

namespace thermovox {

// The words and tables of a report. What is called `html` below stands in the page as it is; all text from
// outside goes through escaped() or named() first.

/// Text so that HTML shows it and nothing else, also within an attribute in double quotes. What is not
/// printable UTF-8 becomes question marks.
[[nodiscard]] std::string escaped(std::string_view text);
/// The same for a name from outside, kept from turning the text around it (bidirectional isolation).
[[nodiscard]] std::string named(std::string_view text);

/// "2026-11-22 15:20:03 UTC" on one line; "12.300 s" where the recorder did not know the calendar (before
/// 1973).
[[nodiscard]] std::string dateText(Time time);
/// "60.1 &pm; 2.2": the value and one sigma.
[[nodiscard]] std::string estimateText(const Estimate& estimate);
/// "1.440, -2.427, 2.122".
[[nodiscard]] std::string vectorText(const Eigen::Vector3d& v, int decimals);
/// "123 456".
[[nodiscard]] std::string groupedText(std::size_t number);
/// "12 %", with a decimal below ten.
[[nodiscard]] std::string shareText(std::size_t part, std::size_t whole);
/// "1 mission", "2 missions".
[[nodiscard]] std::string countText(std::size_t number, const std::string& noun);

/// A table that print does not cut when it is short; a long one has its head on every page.
class HtmlTable {
 public:
  /// `html` of the columns' heads, and a letter for each: l for words, r for numbers.
  HtmlTable(std::vector<std::string> heads, std::string alignment);
  void row(const std::vector<std::string>& html);
  [[nodiscard]] std::string html() const;

 private:
  [[nodiscard]] std::string line(const std::vector<std::string>& html, const char* tag) const;

  std::string alignment_;
  std::string head_;
  std::string body_;
  std::size_t rows_ = 0;
};

/// A table of what is called how: names on the left, values on the right.
[[nodiscard]] std::string factTable(const std::vector<std::pair<std::string, std::string>>& html);

/// "data:image/png;base64,..." of the bytes of a PNG, "data:image/jpeg;..." of a JPEG's.
[[nodiscard]] std::string pictureUrl(std::string_view bytes);

/// A whole document with the style of the reports: nothing in it is fetched or run.
[[nodiscard]] std::string htmlDocument(const std::string& title, const std::string& body);

}  // namespace thermovox
