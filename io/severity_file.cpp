#include "io/severity_file.hpp"

#include <utility>

#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "io/yaml_map.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kLargestSeverityFile = std::size_t{1} << 20;  // bytes; it has a few lines

/// Text for reports.
std::string printable(const YamlMap& map, std::string_view key) {
  std::string text = map.text(key);
  if (!isPrintableUtf8(text)) {
    throw ConfigError(map.place(key) + ": found " + inQuotes(text) + ", expected printable UTF-8");
  }
  return text;
}

std::vector<SeverityClass> readClasses(const YamlMap& map, std::string_view key) {
  std::vector<SeverityClass> classes;
  for (const YamlMap& entry : map.mapOrList(key)) {
    entry.allow({"up_to", "name", "action"});
    SeverityClass one{.name = printable(entry, "name"), .action = printable(entry, "action")};
    if (const std::optional<double> up_to = entry.numberIf("up_to")) one.up_to = *up_to;
    classes.push_back(std::move(one));
  }
  return classes;
}

}  // namespace

SeverityTable parseSeverity(const std::string& text, const std::string& name) {
  const YamlMap map = YamlMap::parse(text, name);
  map.allow({"name", "edition", "over_ambient", "over_similar"});
  SeverityTable table{.name = printable(map, "name"),
                      .edition = printable(map, "edition"),
                      .over_ambient = readClasses(map, "over_ambient"),
                      .over_similar = readClasses(map, "over_similar")};
  try {
    table.validate();
  } catch (const ConfigError& error) {
    throw ConfigError(name + ", " + error.what());
  }
  return table;
}

SeverityTable readSeverity(const std::filesystem::path& file) {
  return parseSeverity(readWhole(file, "", kLargestSeverityFile), file.string());
}

}  // namespace thermovox
