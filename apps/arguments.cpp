#include "apps/arguments.hpp"

#include <algorithm>
#include <cmath>

#include "apps/usable_memory.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "io/pose_text.hpp"

namespace thermovox {
namespace {

constexpr std::uint64_t kMegabyte = 1'000'000;
constexpr std::uint64_t kMostMegabytes = 1'000'000'000;
constexpr int kMostThreads = 1024;

}  // namespace

CLI::Validator isFinite() {
  const auto check = [](const std::string& text) -> std::string {
    const std::optional<double> number = parseNumber(text);
    return number && std::isfinite(*number) ? "" : "found " + text + ", expected a finite number";
  };
  return CLI::Validator(check, "");
}

CLI::Option* addPalette(CLI::App& verb, Palette& palette) {
  std::map<std::string, Palette> choices;
  for (const auto& [name, value] : namedPalettes()) choices.emplace(name, value);
  return addChoice(verb, "--palette", palette, choices, "Colours of the temperatures (default inferno)");
}

std::optional<TemperatureSpan> spanFrom(const std::vector<double>& span) {
  if (span.size() != 2) return std::nullopt;
  if (!(std::isfinite(span[0]) && std::isfinite(span[1]) && span[0] < span[1])) {
    throw UsageError("--span: expected two temperatures LO < HI, in C");
  }
  return TemperatureSpan{span[0], span[1]};
}

void refuseOptions(const std::vector<CLI::Option*>& options, const std::string& why) {
  for (const CLI::Option* option : options) {
    if (option->count() > 0) throw UsageError(option->get_name() + ": " + why);
  }
}

void addThreadsOption(CLI::App& verb, int& threads) {
  const auto set = [&threads](int asked) {
    if (asked < 0 || asked > kMostThreads) {
      throw UsageError("--threads: found " + std::to_string(asked) + ", expected 1 to " +
                       std::to_string(kMostThreads) + " (or 0 for all processors)");
    }
    threads = asked;
  };
  verb.add_option_function<int>("--threads", set,
                                "Threads to work with; the result is the same for any number (default 0: one "
                                "for each processor)")
      ->type_name("N");
}

void addMemoryOption(CLI::App& verb, std::uint64_t& bytes, const std::string& help) {
  bytes = usableMemory() / 2;
  const auto set = [&bytes](std::uint64_t megabytes) {
    if (megabytes < 1 || megabytes > kMostMegabytes) {
      throw UsageError("--memory: found " + std::to_string(megabytes) + " MB, expected 1 to " +
                       std::to_string(kMostMegabytes) + " MB");
    }
    bytes = megabytes * kMegabyte;
  };
  verb.add_option_function<std::uint64_t>("--memory", set,
                                          help + " (default: half of the machine's or container's)")
      ->type_name("MB");
}

Pose poseFrom(const std::string& text, const std::string& option) {
  const bool is_file = std::filesystem::is_regular_file(text);
  if (const std::optional<Pose> pose = parsePose(is_file ? readWhole(text) : text)) return *pose;
  throw UsageError(option + ": found '" + text +
                   "', expected \"tx ty tz qx qy qz qw\" with a unit quaternion, or a file that holds that");
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
