#include <fstream>
#include <string>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

constexpr const char* kCalibrate = "calibrate laser board -o rig.yaml --report report.html ";

void takeCaptures(const TestFolder& folder, int captures) {
  ASSERT_EQ(
      thermovox(folder.path(), "simulate board --laser cloud --captures " + std::to_string(captures)).code,
      0);
}

TEST(CalibrationReportVerb, WritesAReportBesideTheRigAndReplacesNothingUnasked) {
  const TestFolder folder;
  takeCaptures(folder, 6);
  const Outcome outcome = thermovox(folder.path(), kCalibrate);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string html = bytesOf(folder / "report.html");
  EXPECT_THAT(html, testing::HasSubstr("<b>These captures determine the laser&#39;s pose</b>"));
  EXPECT_THAT(html, testing::HasSubstr("id=\"capture-6\""));
  EXPECT_THAT(html, testing::Not(testing::HasSubstr(folder.path().string())));
  ASSERT_TRUE(std::filesystem::remove(folder / "rig.yaml"));
  expectOneLineOfError(thermovox(folder.path(), kCalibrate), {"report.html", "exists already"});
  EXPECT_FALSE(std::filesystem::exists(folder / "rig.yaml"));
  EXPECT_EQ(thermovox(folder.path(), std::string(kCalibrate) + "--force --threads 1").code, 0);
  EXPECT_EQ(bytesOf(folder / "report.html"), html);
}

TEST(CalibrationReportVerb, TellsWhyCapturesCannotDetermineTheAnswer) {
  const TestFolder folder;
  takeCaptures(folder, 2);
  EXPECT_EQ(thermovox(folder.path(), kCalibrate).code, 3);
  EXPECT_THAT(bytesOf(folder / "report.html"), testing::HasSubstr("do not determine the laser&#39;s pose"));
  EXPECT_FALSE(std::filesystem::exists(folder / "rig.yaml"));
}

TEST(CalibrationReportVerb, ShowsTheImagesWhereNoBoardIsFound) {
  const TestFolder folder;
  takeCaptures(folder, 1);
  std::string yaml = bytesOf(folder / "board" / "captures.yaml");
  const std::string board = "inner_corners: [";
  const std::size_t at = yaml.find(board);
  ASSERT_NE(at, std::string::npos) << yaml;
  yaml.insert(at + board.size(), 1, '1');  // 19 columns
  std::ofstream(folder / "board" / "captures.yaml") << yaml;
  // The thermal camera alone: a board that is not there is sought for minutes in a large picture.
  EXPECT_EQ(thermovox(folder.path(), "calibrate camera board -o rig.yaml --report report.html").code, 3);
  const std::string html = bytesOf(folder / "report.html");
  EXPECT_THAT(html, testing::HasSubstr("do not determine"));
  EXPECT_THAT(html, testing::HasSubstr("<b>no board was found</b>"));
}

TEST(CalibrationReportVerb, TakesNothingButHtml) {
  const TestFolder folder;
  takeCaptures(folder, 1);
  EXPECT_EQ(thermovox(folder.path(), "calibrate laser board -o rig.yaml --report report.pdf").code, 2);
}

}  // namespace
}  // namespace thermovox::test
