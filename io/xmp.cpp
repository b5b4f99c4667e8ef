#include "io/xmp.hpp"

#include <cctype>
#include <cmath>
#include <vector>

#include "io/number_text.hpp"

namespace thermovox {
namespace {

bool isOfName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
}

std::string_view stripped(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The prefix of the property whose name begins at `place`; nullopt where another name merely ends so.
std::optional<std::string_view> prefixBefore(std::string_view packet, std::size_t place) {
  if (place == 0 || packet[place - 1] != ':') return std::nullopt;
  std::size_t begin = place - 1;
  while (begin > 0 && isOfName(packet[begin - 1])) --begin;
  if (begin > 0 && packet[begin - 1] == '/') return std::nullopt;  // the end of an element
  return packet.substr(begin, place - 1 - begin);
}

/// Text without the marks of lists around it: their items, separated by commas.
std::string withoutMarks(std::string_view text) {
  std::string plain;
  bool in_mark = false;
  for (const char c : text) {
    if (c == '<') in_mark = true;
    if (!in_mark) plain += c;
    if (c != '>') continue;
    in_mark = false;
    if (!stripped(plain).empty() && !stripped(plain).ends_with(',')) plain += ',';
  }
  std::string_view items = stripped(plain);
  while (items.ends_with(',')) items = stripped(items.substr(0, items.size() - 1));
  return std::string(items);
}

/// What stands behind a property's name.
std::optional<std::string> valueBehind(std::string_view packet, std::size_t place) {
  const std::string_view rest = packet.substr(place);
  const std::size_t mark = rest.find_first_not_of(" \t\r\n");
  if (mark == std::string_view::npos) return std::nullopt;
  if (rest[mark] == '=') {
    const std::size_t open = rest.find_first_of("\"'", mark);
    if (open == std::string_view::npos) return std::nullopt;
    const std::size_t close = rest.find(rest[open], open + 1);
    if (close == std::string_view::npos) return std::nullopt;
    return std::string(stripped(rest.substr(open + 1, close - open - 1)));
  }
  const std::size_t open = rest.find('>');
  if (open == std::string_view::npos || (open > 0 && rest[open - 1] == '/')) return std::nullopt;
  // The element ends where its own name does; a list inside has names of its own.
  const std::size_t end_of_list = rest.find("</rdf:Seq>", open);
  const std::size_t close = rest.find("</", open);
  const bool list = stripped(rest.substr(open + 1, 64)).starts_with("<rdf:Seq");
  const std::size_t end = list ? end_of_list : close;
  if (end == std::string_view::npos) return std::nullopt;
  return withoutMarks(rest.substr(open + 1, end - open - 1));
}

std::vector<double> numbersOf(const std::optional<std::string>& text) {
  std::vector<double> numbers;
  std::string_view rest = text ? std::string_view(*text) : std::string_view();
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const auto number = parseNumber(stripped(rest.substr(0, comma)));
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  }
  return numbers;
}

}  // namespace

std::optional<std::string> xmpText(std::string_view packet, std::string_view name, std::string_view prefix) {
  constexpr std::size_t longest = std::size_t{1} << 20;  // cameras write some kilobytes
  packet = packet.substr(0, longest);
  for (std::size_t place = packet.find(name); place != std::string_view::npos;
       place = packet.find(name, place + 1)) {
    const std::size_t end = place + name.size();
    if (end >= packet.size() || isOfName(packet[end])) continue;
    const auto found = prefixBefore(packet, place);
    if (!found || (!prefix.empty() && *found != prefix)) continue;
    if (auto value = valueBehind(packet, end)) return value;
  }
  return std::nullopt;
}

std::optional<double> xmpNumber(std::string_view packet, std::string_view name, std::string_view prefix) {
  const std::optional<std::string> text = xmpText(packet, name, prefix);
  if (!text) return std::nullopt;
  const std::size_t slash = text->find('/');
  const auto above = parseNumber(text->substr(0, slash));
  if (!above || !std::isfinite(*above)) return std::nullopt;
  if (slash == std::string::npos) return above;
  const auto below = parseNumber(text->substr(slash + 1));
  if (!below || !std::isfinite(*below) || *below == 0.0) return std::nullopt;
  return *above / *below;
}

XmpFacts xmpFacts(std::string_view packet) {
  return {.t_linear_gain = xmpNumber(packet, "TlinearGain"),
          .yaw_deg = xmpNumber(packet, "Yaw", "Camera"),
          .pitch_deg = xmpNumber(packet, "Pitch", "Camera"),
          .roll_deg = xmpNumber(packet, "Roll", "Camera"),
          .focal_length_mm = xmpNumber(packet, "PerspectiveFocalLength", "Camera"),
          .principal_point_mm = numbersOf(xmpText(packet, "PrincipalPoint", "Camera")),
          .perspective_distortion = numbersOf(xmpText(packet, "PerspectiveDistortion", "Camera"))};
}

}  // namespace thermovox
