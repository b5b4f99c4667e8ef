#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/palette.hpp"
#include "projection/error.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// A command line that asks for what cannot be: exit code 2, as for one that cannot be parsed.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// An option that is one of several words. Help and refusals show the words and nothing else.
template <typename Value, typename Target>
CLI::Option* addChoice(CLI::App& verb, const std::string& name, Target& value,
                       const std::map<std::string, Value>& choices, const std::string& help) {
  std::string words;
  for (const auto& [word, meaning] : choices) words += (words.empty() ? "" : "|") + word;
  const auto choose = [name, words, choices, &value](const std::string& word) {
    const auto choice = choices.find(word);
    if (choice == choices.end()) throw UsageError(name + ": found '" + word + "', expected " + words);
    value = choice->second;
  };
  return verb.add_option_function<std::string>(name, choose, help)->type_name(words);
}

/// A check of options: CLI11's own of ranges lets nan pass.
[[nodiscard]] CLI::Validator isFinite();

/// `--palette NAME`.
CLI::Option* addPalette(CLI::App& verb, Palette& palette);

/// `--span LO HI`. None where it was not given; throws UsageError unless both are finite and LO < HI.
[[nodiscard]] std::optional<TemperatureSpan> spanFrom(const std::vector<double>& span);

/// Throws UsageError, naming it, when one of these options was given: what it asks for would not be done.
void refuseOptions(const std::vector<CLI::Option*>& options, const std::string& why);

/// `--threads N`: 0, as where it is not given, for one for each processor; the help says so.
void addThreadsOption(CLI::App& verb, int& threads);

/// `--memory MB`, kept in bytes; half of what this process may use where it is not given.
void addMemoryOption(CLI::App& verb, std::uint64_t& bytes, const std::string& help);

/// A pose that was given as seven numbers, "tx ty tz qx qy qz qw", or as the name of a file that holds them.
/// Throws UsageError naming the option for anything else.
[[nodiscard]] Pose poseFrom(const std::string& text, const std::string& option);

/// Throws UsageError unless the path's ending, whatever its case, is one of these.
void checkEnding(const std::filesystem::path& path, const std::vector<std::string>& endings);

}  // namespace thermovox
