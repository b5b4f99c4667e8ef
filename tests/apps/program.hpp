#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "apps/simulate/mission_writer.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::test {

/// What a run of a program left: its exit code (minus the signal's number if one ended it) and its words.
struct Outcome {
  int code = 0;
  std::string out;
  std::string err;

  /// stdout as the one JSON object that it has to be.
  [[nodiscard]] nlohmann::json json() const {
    const nlohmann::json parsed = nlohmann::json::parse(out, nullptr, false);
    EXPECT_TRUE(parsed.is_object()) << "stdout is not one JSON object: " << out;
    return parsed;
  }
};

/// Runs a line of the shell in a folder. Its words are kept elsewhere.
[[nodiscard]] inline Outcome runShell(const std::filesystem::path& folder, const std::string& line) {
  const TestFolder words;
  const auto quoted = [](const std::filesystem::path& path) { return fmt::format("'{}'", path.string()); };
  const std::string command = fmt::format("cd {} && {{ {}\n}} >{} 2>{} </dev/null", quoted(folder), line,
                                          quoted(words / "out"), quoted(words / "err"));
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return {code, bytesOf(words / "out"), bytesOf(words / "err")};
}

inline constexpr const char* kThermovox = "'" THERMOVOX_PROGRAM "' ";

/// Runs thermovox in a folder.
[[nodiscard]] inline Outcome thermovox(const std::filesystem::path& folder, const std::string& arguments) {
  return runShell(folder, kThermovox + arguments);
}

/// Everything under a folder.
[[nodiscard]] inline std::set<std::string> namesUnder(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    names.insert(std::filesystem::relative(entry.path(), folder).string());
  }
  return names;
}

/// A second of a simulated mission, its thermal images coarsely sampled to be quick.
inline std::filesystem::path flyMission(const TestFolder& folder, const std::string& name,
                                        LaserKind laser = LaserKind::beam, std::uint64_t seed = 11) {
  simulate::SimulationOptions options;
  options.laser = laser;
  options.seed = seed;
  options.duration = 1.0;
  options.supersampling = 1;
  simulate::simulateMission(options, folder / name);
  return folder / name;
}

/// Exit code 1, nothing on stdout, one line on stderr that holds all of `words`.
inline void expectOneLineOfError(const Outcome& outcome, const std::vector<std::string>& words) {
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("thermovox: ") && outcome.err.ends_with("\n")) << outcome.err;
  EXPECT_THAT(outcome.err, testing::Not(testing::HasSubstr("unexpected error")));
  for (const std::string& word : words) EXPECT_THAT(outcome.err, testing::HasSubstr(word));
}

/// Runs thermovox, which has to fail with one line that holds all of `words` and to leave no file.
inline void expectRefused(const std::filesystem::path& folder, const std::string& arguments,
                          const std::vector<std::string>& words) {
  SCOPED_TRACE(arguments);
  const std::set<std::string> before = namesUnder(folder);
  expectOneLineOfError(thermovox(folder, arguments), words);
  EXPECT_EQ(namesUnder(folder), before);
}

/// Puts `after` in place of the first `before` in a file.
inline void replaceIn(const std::filesystem::path& file, const std::string& before,
                      const std::string& after) {
  std::string text = bytesOf(file);
  const std::size_t place = text.find(before);
  ASSERT_NE(place, std::string::npos) << before << " is not in " << file;
  text.replace(place, before.size(), after);
  std::ofstream(file, std::ios::binary) << text;
}

inline void truncateTo(const std::filesystem::path& file, double share) {
  const auto size = static_cast<double>(std::filesystem::file_size(file));
  std::filesystem::resize_file(file, static_cast<std::uintmax_t>(size * share));
}

}  // namespace thermovox::test
