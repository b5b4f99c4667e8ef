#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A second of a flight, mapped with wide cells.
class CliReport : public testing::Test {
 protected:
  void SetUp() override {
    flyMission(folder, "hall", LaserKind::cloud);
    ASSERT_EQ(thermovox(folder.path(), "map hall --station s.tvx --resolution 0.1").code, 0);
  }
  TestFolder folder;
};

TEST_F(CliReport, WritesOneFileThatSaysTheSameEveryTime) {
  const Outcome first = thermovox(folder.path(), "report s.tvx a.html --delta 5 --title 'Hall & <yard>'");
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("a.html"));
  EXPECT_EQ(thermovox(folder.path(), "report s.tvx b.html --delta 5 --title 'Hall & <yard>'").code, 0);
  const std::string html = bytesOf(folder / "a.html");
  EXPECT_EQ(html, bytesOf(folder / "b.html"));
  EXPECT_THAT(html, HasSubstr("Hall &amp; &lt;yard&gt;"));
  EXPECT_THAT(html, HasSubstr("5 &deg;C or more over the surroundings"));
  EXPECT_THAT(html, Not(HasSubstr(folder.path().string())));
}

TEST_F(CliReport, NothingFoundIsAReportToo) {
  EXPECT_EQ(thermovox(folder.path(), "report s.tvx a.html --above 900").code, 0);
  EXPECT_THAT(bytesOf(folder / "a.html"), HasSubstr("No hot spot was found"));
}

TEST_F(CliReport, ReplacesNothingUnasked) {
  folder.write("a.html", "mine");
  expectRefused(folder.path(), "report s.tvx a.html", {"a.html"});
  EXPECT_EQ(bytesOf(folder / "a.html"), "mine");
  EXPECT_EQ(thermovox(folder.path(), "report s.tvx a.html --force").code, 0);
  EXPECT_THAT(bytesOf(folder / "a.html"), HasSubstr("<!DOCTYPE html>"));
}

TEST_F(CliReport, WithoutABrowserAPdfIsRefusedWithWhatToInstall) {
  const Outcome outcome =
      runShell(folder.path(), "PATH=/nowhere " + std::string(kThermovox) + "report s.tvx a.pdf");
  expectOneLineOfError(outcome, {"chromium", ".ci/packages.sh report"});
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pdf"));
}

/// What stands in for a browser: a script of this name on the PATH.
void plantBrowser(const TestFolder& folder, const std::string& script) {
  namespace fs = std::filesystem;
  fs::permissions(folder.write("bin/chromium", "#!/bin/sh\n" + script + "\n"), fs::perms::owner_all);
}

TEST_F(CliReport, ABrowserThatFailsIsNamedAndLeavesNothing) {
  plantBrowser(folder, "echo it went wrong >&2; exit 3");
  const Outcome outcome =
      runShell(folder.path(), "PATH=\"$PWD/bin:$PATH\" " + std::string(kThermovox) + "report s.tvx a.pdf");
  expectOneLineOfError(outcome, {"bin/chromium", "status 3", "it went wrong"});
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pdf"));
}

TEST_F(CliReport, ABrowserGetsTheReportAndItsPdfIsTaken) {
  plantBrowser(
      folder,
      "for word; do case $word in --print-to-pdf=*) out=${word#*=};; file://*) in=${word#file://};; esac; "
      "done\n{ echo '%PDF-1.4'; echo \"/CreationDate (D:20200101000000+00'00')\"; grep -c '<html' \"$in\"; } "
      "> \"$out\"");
  const Outcome outcome =
      runShell(folder.path(), "export SOURCE_DATE_EPOCH=0\n" + std::string(kThermovox) +
                                  "map hall --station t.tvx --resolution 0.1 && PATH=\"$PWD/bin:$PATH\" " +
                                  kThermovox + "report t.tvx a.pdf");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(bytesOf(folder / "a.pdf"), "%PDF-1.4\n/CreationDate (D:19700101000000+00'00')\n1\n");
}

TEST_F(CliReport, OtherEndingsAreWrongUsage) {
  EXPECT_EQ(thermovox(folder.path(), "report s.tvx a.docx").code, 2);
  EXPECT_EQ(thermovox(folder.path(), "report s.tvx").code, 2);
}

}  // namespace
}  // namespace thermovox::test
