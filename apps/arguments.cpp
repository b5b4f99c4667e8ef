#include "apps/arguments.hpp"

#include <algorithm>
#include <cmath>

#include "io/atomic_file.hpp"

namespace thermovox {

void addPalette(CLI::App& verb, Palette& palette) {
  std::map<std::string, Palette> choices;
  for (const auto& [name, value] : namedPalettes()) choices.emplace(name, value);
  addChoice(verb, "--palette", palette, choices, "Colours of the temperatures (default inferno)");
}

std::optional<TemperatureSpan> spanFrom(const std::vector<double>& span) {
  if (span.size() != 2) return std::nullopt;
  if (!(std::isfinite(span[0]) && std::isfinite(span[1]) && span[0] < span[1])) {
    throw UsageError("--span: expected two temperatures LO < HI, in C");
  }
  return TemperatureSpan{span[0], span[1]};
}

void checkEnding(const std::filesystem::path& path, const std::vector<std::string>& endings) {
  const std::string ending = endingOf(path);
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  std::string expected;
  for (const std::string& known : endings) {
    expected += expected.empty() ? "" : known == endings.back() ? " or " : ", ";
    expected += known;
  }
  throw UsageError(path.string() + ": the ending is '" + ending + "', expected " + expected);
}

}  // namespace thermovox
