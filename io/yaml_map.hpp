#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace YAML {
class Node;
}

namespace thermovox {

/// A mapping in a YAML file, asked key by key. Every complaint is a ConfigError that names the file and the
/// way to the key ("rig.yaml, laser[1].range_max: ..."), so that callers only say what they want.
class YamlMap {
 public:
  /// Parses a document whose top is a mapping; `name` stands for it in messages.
  [[nodiscard]] static YamlMap parse(const std::string& text, const std::string& name);

  /// A key that is not among these is a typing error, and so is a key given twice.
  void allow(std::initializer_list<std::string_view> keys) const;

  [[nodiscard]] bool has(std::string_view key) const;

  /// Finite numbers, text and sub-mappings; the plain forms insist on the key.
  [[nodiscard]] double number(std::string_view key) const;
  [[nodiscard]] std::optional<double> numberIf(std::string_view key) const;
  [[nodiscard]] int integer(std::string_view key) const;
  [[nodiscard]] std::string text(std::string_view key) const;
  [[nodiscard]] std::optional<std::string> textIf(std::string_view key) const;
  /// A text that may also name a file: printable UTF-8 without '/' that does not begin with a dot.
  [[nodiscard]] std::string plainName(std::string_view key) const;
  [[nodiscard]] YamlMap map(std::string_view key) const;
  [[nodiscard]] std::optional<YamlMap> mapIf(std::string_view key) const;

  /// All the numbers below a key, row by row where they are written as lists of lists.
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const;
  /// The same, and exactly so many.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count) const;

  /// One entry or a list of them; empty where the key is missing.
  [[nodiscard]] std::vector<std::string> textOrList(std::string_view key) const;
  [[nodiscard]] std::vector<YamlMap> mapOrList(std::string_view key) const;

  /// "rig.yaml, laser.kind": the place of a key in messages; of the mapping itself for "".
  [[nodiscard]] std::string place(std::string_view key) const;

 private:
  YamlMap(std::shared_ptr<const YAML::Node> node, std::string name, std::string path);
  [[nodiscard]] YAML::Node find(std::string_view key) const;
  [[nodiscard]] YAML::Node require(std::string_view key) const;
  [[nodiscard]] YamlMap below(const YAML::Node& node, const std::string& key) const;

  std::shared_ptr<const YAML::Node> node_;
  std::string name_;
  std::string path_;
};

}  // namespace thermovox
