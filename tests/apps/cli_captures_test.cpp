#include <string>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;

TEST(SimulateCapturesVerb, WritesTheFolderAndTheTruthBesideIt) {
  const TestFolder folder;
  const Outcome outcome = thermovox(folder.path(), "simulate board --laser beam --captures 1");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("captures board\n"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("board.truth_rig.yaml\n"));
  EXPECT_THAT(
      namesUnder(folder.path()),
      testing::UnorderedElementsAre("board", "board.truth.json", "board.truth_rig.yaml",
                                    "board/captures.yaml", "board/captures.csv", "board/rig.yaml",
                                    "board/000_thermal.tiff", "board/000_visible.jpg", "board/000_beam.csv"));
  EXPECT_EQ(thermovox(folder.path(), "info board --json").json().at("kind"), "captures");
}

TEST(SimulateCapturesVerb, TakesNoOptionsOfMissionsNorMissionsThoseOfCaptures) {
  const TestFolder folder;
  for (const char* arguments : {
           "simulate board --laser beam --captures 0",
           "simulate board --laser beam --captures 2 --duration 1",
           "simulate board --laser beam --captures 2 --frames rjpeg",
           "simulate board --laser beam --captures 2 --air 20",
           "simulate board --laser beam --captures 2 --visible",
           "simulate board --laser beam --captures 2 --hall-seed 3",
           "simulate board --laser beam --captures 2 --pose-sigma 0.1 0.1",
           "simulate board --laser beam --captures 2 --spoiled 3",
           "simulate board --laser scan --captures 2 --edge-captures 1",
           "simulate board --laser scan --captures 2 --guess-error nan 1",
           "simulate board --laser scan --captures 2 --contrast 40",
           "simulate board --laser beam --spoiled 1",
           "simulate board --laser beam --edge-captures 1",
           "simulate board --laser beam --contrast 5",
           "simulate board --laser beam --capture-bias-sigma 0.01",
           "simulate board --laser beam --guess-error 1 0.01",
       }) {
    const Outcome outcome = thermovox(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_THAT(outcome.out, testing::IsEmpty()) << arguments;
    EXPECT_THAT(outcome.err, testing::Not(testing::IsEmpty())) << arguments;
  }
  EXPECT_THAT(namesUnder(folder.path()), testing::IsEmpty());
}

TEST(SimulateCapturesVerb, ReplacesOnlyCaptures) {
  const TestFolder folder;
  const std::string board = "simulate board --laser beam --captures 1 ";
  ASSERT_EQ(thermovox(folder.path(), board).code, 0);
  const auto before = namesUnder(folder.path());
  const std::string beam = bytesOf(folder / "board" / "000_beam.csv");
  const std::string rig = bytesOf(folder / "board.truth_rig.yaml");
  expectRefused(folder.path(), board, {"board", "exists already"});
  EXPECT_EQ(thermovox(folder.path(), board + "--seed 2 --force").code, 0);
  EXPECT_NE(bytesOf(folder / "board" / "000_beam.csv"), beam);
  EXPECT_NE(bytesOf(folder / "board.truth_rig.yaml"), rig);
  EXPECT_EQ(namesUnder(folder.path()), before);
  expectRefused(folder.path(), "simulate board --laser beam --duration 0.3 --force", {"board", "no mission"});
  flyMission(folder, "hall");
  expectRefused(folder.path(), "simulate hall --laser beam --captures 1 --force", {"hall", "no captures"});
}

TEST(SimulateCapturesVerb, KeepsTheOldCapturesWhereNewOnesFail) {
  const TestFolder folder;
  ASSERT_EQ(thermovox(folder.path(), "simulate board --laser beam --captures 1").code, 0);
  const auto before = namesUnder(folder.path());
  const std::string beam = bytesOf(folder / "board" / "000_beam.csv");
  // A limit on the size of files: the visible picture cannot be written.
  const Outcome outcome =
      runShell(folder.path(), "ulimit -f 40; trap '' XFSZ; " + std::string(kThermovox) +
                                  "simulate board --laser beam --captures 1 --seed 2 --force");
  expectOneLineOfError(outcome, {"board"});
  EXPECT_EQ(namesUnder(folder.path()), before);
  EXPECT_EQ(bytesOf(folder / "board" / "000_beam.csv"), beam);
}

}  // namespace
}  // namespace thermovox::test
