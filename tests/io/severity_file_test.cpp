#include "io/severity_file.hpp"

#include <gmock/gmock.h>

#include "projection/error.hpp"
#include "tests/io/readme_example.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The table that io/README.md shows.
std::string example() {
  return test::readmeExample("name: ANSI/NETA");
}

std::string with(std::string_view old_part, std::string_view new_part) {
  return test::replaced(example(), old_part, new_part);
}

std::string complaintAbout(const std::string& text) {
  return test::messageOf<ConfigError>([&] { static_cast<void>(parseSeverity(text, "s.yaml")); });
}

TEST(SeverityFile, TheExampleOfTheReadmeIsTheDefault) {
  EXPECT_EQ(parseSeverity(example(), "s.yaml"), netaSeverity());
}

TEST(SeverityFile, ReadsAFileWithOneBasis) {
  const test::TestFolder folder;
  const SeverityTable table = readSeverity(
      folder.write("own.yaml",
                   "name: ours\nedition: 3\nover_similar:\n- {name: warm, up_to: 5, action: look}\n"
                   "- {name: hot, action: stop}\n"));
  EXPECT_EQ(table.edition, "3");
  EXPECT_TRUE(table.over_ambient.empty());
  EXPECT_EQ(table.classOf(SeverityBasis::over_similar, 5.01)->action, "stop");
}

TEST(SeverityFile, ComplaintsNameFileKeyAndWhatWasExpected) {
  EXPECT_THAT(complaintAbout(with("up_to: 20", "up_to: 9")),
              AllOf(HasSubstr("s.yaml, over_ambient[1].up_to: is 9"), HasSubstr("above 10")));
  EXPECT_THAT(complaintAbout(with("up_to: 3", "up_to: 0")), HasSubstr("s.yaml, over_similar[0].up_to: is 0"));
  EXPECT_THAT(complaintAbout(with("up_to: 10", "up_to: .nan")), HasSubstr("over_ambient[0].up_to: found"));
  EXPECT_THAT(complaintAbout(with("up_to: 10", "up_to: .inf")), HasSubstr("over_ambient[0].up_to: found"));
  EXPECT_THAT(complaintAbout(with("up_to: 10", "up_to: nan")), HasSubstr("expected a finite number"));
  EXPECT_THAT(complaintAbout(with("{up_to: 10", "{upto: 10")),
              AllOf(HasSubstr("over_ambient[0]: unknown key 'upto'"), HasSubstr("up_to, name, action")));
  EXPECT_THAT(complaintAbout(with("{name: major", "{up_to: 99, name: major")),
              HasSubstr("over_ambient[3].up_to: is 99"));
  EXPECT_THAT(complaintAbout(with("up_to: 40, ", "")), HasSubstr("over_ambient[2].up_to: is inf"));
  EXPECT_THAT(complaintAbout(with("name: probable", "name: possible")), HasSubstr("over_ambient[1].name"));
  EXPECT_THAT(complaintAbout(with("edition: 2019", "")), HasSubstr("s.yaml, edition: is missing"));
  EXPECT_THAT(complaintAbout(with("name: monitor", "name: \"a\\tb\"")),
              HasSubstr("expected printable UTF-8"));
  EXPECT_THAT(complaintAbout("name: a\nedition: b\n"), HasSubstr("s.yaml, over_ambient: has no class"));
  EXPECT_THAT(complaintAbout("name: a\nedition: b\nover_ambient: [1]\n"),
              HasSubstr("over_ambient[0]: found '1'"));
}

TEST(SeverityFile, RefusesFilesThatAreCutOffOrNotThere) {
  const std::string whole = example();
  for (std::size_t length = 0; length + 2 < whole.size(); length += 7) {
    try {
      parseSeverity(whole.substr(0, length), "s.yaml").validate();  // what is left may be a table of its own
    } catch (const ConfigError&) {
    }
  }
  EXPECT_THROW(static_cast<void>(readSeverity("/no/such/severity.yaml")), DataError);
}

}  // namespace
}  // namespace thermovox
