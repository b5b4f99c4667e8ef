#include "io/cloud_layout.hpp"

#include <algorithm>

namespace thermovox {

void splitWords(std::string_view line, std::vector<std::string_view>& words) {
  constexpr std::string_view kBlanks = " \t\r\f\v";
  words.clear();
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
}

bool HeaderLines::next() {
  if (offset_ >= bytes_.size()) return false;
  const std::size_t end = std::min(bytes_.find('\n', offset_), bytes_.size());
  splitWords(bytes_.substr(offset_, end - offset_), words_);
  offset_ = std::min(end + 1, bytes_.size());
  ++number_;
  return true;
}

}  // namespace thermovox
