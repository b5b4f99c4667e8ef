#include "io/yaml_map.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr int kDeepestList = 2;  // a matrix is a list of lists

std::string joined(std::initializer_list<std::string_view> words) {
  std::string result;
  for (const std::string_view word : words) result += (result.empty() ? "" : ", ") + std::string(word);
  return result;
}

std::string found(const YAML::Node& node) {
  if (node.IsMap()) return "found a mapping";
  if (node.IsSequence()) return "found a list";
  if (node.IsNull()) return "found nothing";
  return "found " + inQuotes(node.Scalar());
}

double numberOf(const YAML::Node& node, const std::string& place) {
  const std::optional<double> number = node.IsScalar() ? parseNumber(node.Scalar()) : std::nullopt;
  if (!number || !std::isfinite(*number))
    throw ConfigError(place + ": " + found(node) + ", expected a finite number");
  return *number;
}

std::string textOf(const YAML::Node& node, const std::string& place) {
  if (!node.IsScalar() || node.Scalar().empty())
    throw ConfigError(place + ": " + found(node) + ", expected a text");
  return node.Scalar();
}

void appendNumbers(std::vector<double>& numbers, const YAML::Node& node, const std::string& place,
                   int depth) {
  if (!node.IsSequence() || depth > kDeepestList) {
    numbers.push_back(numberOf(node, place));
    return;
  }
  for (const YAML::Node& entry : node) appendNumbers(numbers, entry, place, depth + 1);
}

YAML::Node load(const std::string& text, const std::string& name) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigError(name + ":" + std::to_string(error.mark.line + 1) + ": is not YAML: " + error.msg);
  }
}

}  // namespace

YamlMap::YamlMap(std::shared_ptr<const YAML::Node> node, std::string name, std::string path)
    : node_(std::move(node)), name_(std::move(name)), path_(std::move(path)) {}

YamlMap YamlMap::parse(const std::string& text, const std::string& name) {
  auto node = std::make_shared<const YAML::Node>(load(text, name));
  if (!node->IsMap())
    throw ConfigError(name + ": " + found(*node) + ", expected a mapping of keys to values");
  return {std::move(node), name, ""};
}

std::string YamlMap::place(std::string_view key) const {
  std::string path = path_;
  if (!path.empty() && !key.empty()) path += '.';
  path += key;
  return path.empty() ? name_ : name_ + ", " + path;
}

void YamlMap::allow(std::initializer_list<std::string_view> keys) const {
  std::set<std::string> seen;
  for (const auto& entry : *node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      throw ConfigError(place("") + ": unknown key " + inQuotes(key) + ", expected one of: " + joined(keys));
    }
    if (!seen.insert(key).second) throw ConfigError(place(key) + ": is given twice, expected once");
  }
}

YAML::Node YamlMap::find(std::string_view key) const {
  for (const auto& entry : *node_) {
    if (entry.first.IsScalar() && entry.first.Scalar() == key && !entry.second.IsNull()) return entry.second;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

YAML::Node YamlMap::require(std::string_view key) const {
  YAML::Node node = find(key);
  if (!node.IsDefined()) throw ConfigError(place(key) + ": is missing");
  return node;
}

YamlMap YamlMap::below(const YAML::Node& node, const std::string& key) const {
  if (!node.IsMap())
    throw ConfigError(place(key) + ": " + found(node) + ", expected a mapping of keys to values");
  return {std::make_shared<const YAML::Node>(node), name_, path_.empty() ? key : path_ + "." + key};
}

bool YamlMap::has(std::string_view key) const {
  return find(key).IsDefined();
}

double YamlMap::number(std::string_view key) const {
  return numberOf(require(key), place(key));
}

std::optional<double> YamlMap::numberIf(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return number(key);
}

int YamlMap::integer(std::string_view key) const {
  const YAML::Node node = require(key);
  const std::optional<int> integer = node.IsScalar() ? parseInteger(node.Scalar()) : std::nullopt;
  if (!integer) throw ConfigError(place(key) + ": " + found(node) + ", expected a whole number");
  return *integer;
}

std::string YamlMap::text(std::string_view key) const {
  return textOf(require(key), place(key));
}

std::optional<std::string> YamlMap::textIf(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return text(key);
}

std::string YamlMap::plainName(std::string_view key) const {
  std::string name = text(key);
  if (name.front() == '.' || name.find('/') != std::string::npos || !isPrintableUtf8(name)) {
    throw ConfigError(place(key) + ": found " + inQuotes(name) +
                      ", expected printable UTF-8 without '/' that does not begin with a dot");
  }
  return name;
}

YamlMap YamlMap::map(std::string_view key) const {
  return below(require(key), std::string(key));
}

std::optional<YamlMap> YamlMap::mapIf(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return map(key);
}

std::vector<double> YamlMap::numbers(std::string_view key) const {
  const YAML::Node node = require(key);
  if (!node.IsSequence()) throw ConfigError(place(key) + ": " + found(node) + ", expected a list of numbers");
  std::vector<double> numbers;
  appendNumbers(numbers, node, place(key), 1);
  return numbers;
}

std::vector<double> YamlMap::numbers(std::string_view key, std::size_t count) const {
  std::vector<double> result = numbers(key);
  if (result.size() != count) {
    throw ConfigError(place(key) + ": has " + std::to_string(result.size()) + " numbers, expected " +
                      std::to_string(count));
  }
  return result;
}

std::vector<std::string> YamlMap::textOrList(std::string_view key) const {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return {};
  if (!node.IsSequence()) return {textOf(node, place(key))};
  std::vector<std::string> result;
  for (const YAML::Node& entry : node) result.push_back(textOf(entry, place(key)));
  return result;
}

std::vector<YamlMap> YamlMap::mapOrList(std::string_view key) const {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return {};
  if (!node.IsSequence()) return {below(node, std::string(key))};
  std::vector<YamlMap> result;
  for (const YAML::Node& entry : node) {
    result.push_back(below(entry, std::string(key) + "[" + std::to_string(result.size()) + "]"));
  }
  return result;
}

}  // namespace thermovox
