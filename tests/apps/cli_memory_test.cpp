// The verb map gives the same bytes on any number of threads and with any memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

/// A third of a second in the simulated hall; sweeps of the cloud are large enough to be shared among
/// threads.
void fly(const TestFolder& folder, const std::string& name, std::uint64_t seed) {
  simulate::SimulationOptions options{.laser = LaserKind::cloud, .seed = seed, .duration = 0.3};
  options.supersampling = 1;
  simulate::simulateMission(options, folder / name);
}

struct Mapped {
  std::string station;  ///< its bytes
  std::string points;   ///< those of the record
  std::size_t spilled_tiles = 0;
};

/// Maps into a new station, at a fixed time of mapping.
Mapped mapped(const TestFolder& folder, const std::string& arguments) {
  SCOPED_TRACE(arguments);
  std::filesystem::remove(folder / "s.tvx");
  const Outcome outcome = runShell(
      folder.path(), std::string("SOURCE_DATE_EPOCH=1700000000 ") + kThermovox +
                         "map --json --station s.tvx --points p.csv --force --resolution 0.05 " + arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return {bytesOf(folder / "s.tvx"), bytesOf(folder / "p.csv"), outcome.json().at("spilled_tiles")};
}

/// Maps on 1, 2 or 8 threads, with enough memory and with `little` (MB), which is not.
void expectTheSameBytes(const TestFolder& folder, const std::string& arguments, int little) {
  const Mapped expected = mapped(folder, arguments + " --threads 1");
  EXPECT_EQ(expected.spilled_tiles, 0U);
  const auto expectSame = [&](const std::string& work) {
    SCOPED_TRACE(arguments + " " + work);
    const Mapped result = mapped(folder, arguments + " " + work);
    EXPECT_TRUE(result.station == expected.station);
    EXPECT_TRUE(result.points == expected.points);
    return result.spilled_tiles;
  };
  EXPECT_EQ(expectSame("--threads 2"), 0U);
  for (const int threads : {1, 8})
    EXPECT_GT(expectSame(fmt::format("--threads {} --memory {}", threads, little)), 10U);
}

class MapMemory : public testing::TestWithParam<const char*> {};

TEST_P(MapMemory, AndThreadsDoNotChangeOneByteHoweverItIsCarved) {
  const TestFolder folder;
  fly(folder, "a", 31);
  fly(folder, "b", 32);
  expectTheSameBytes(folder, std::string("a b --carve ") + GetParam(), 1);
}

TEST_P(MapMemory, AndThreadsDoNotChangeOneByteOfASecondLook) {
  const TestFolder folder;
  fly(folder, "a", 31);
  expectTheSameBytes(folder, std::string("a --two-pass --carve ") + GetParam(), 1);
}

TEST_P(MapMemory, AndThreadsDoNotChangeOneByteOfWhatIsPainted) {
  const TestFolder folder;
  fly(folder, "a", 31);
  fly(folder, "b", 32);
  expectTheSameBytes(folder, std::string("b a --paint --carve ") + GetParam(), 2);
}

INSTANTIATE_TEST_SUITE_P(Carvings, MapMemory, testing::Values("careful", "octomap", "none"),
                         [](const auto& carving) { return std::string(carving.param); });

TEST(MapMemoryOfClouds, DoesNotChangeOneByteOfWhatIsImported) {
  const TestFolder folder;
  fly(folder, "a", 31);
  ASSERT_EQ(thermovox(folder.path(), "map a --resolution 0.02 --station a.tvx").code, 0);
  ASSERT_EQ(thermovox(folder.path(), "export a.tvx cloud.ply").code, 0);
  const auto imported = [&](const std::string& work) {
    const Outcome outcome = runShell(
        folder.path(), std::string("rm -f s.tvx; SOURCE_DATE_EPOCH=1700000000 ") + kThermovox +
                           "map --json --geometry cloud.ply --resolution 0.02 --station s.tvx " + work);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return std::pair(bytesOf(folder / "s.tvx"), outcome.json().at("spilled_tiles").get<int>());
  };
  const auto [expected, none] = imported("--threads 1");
  EXPECT_EQ(none, 0);
  for (const char* work : {"--threads 8 --memory 1", "--threads 1 --memory 1", "--threads 2"}) {
    const auto [station, spilled] = imported(work);
    EXPECT_TRUE(station == expected) << work;
    EXPECT_EQ(spilled > 10, std::string(work).ends_with("--memory 1")) << spilled;
  }
}

TEST(MergeMemory, DoesNotChangeOneByteOfWhatIsMoved) {
  const TestFolder folder;
  fly(folder, "a", 31);
  fly(folder, "b", 32);
  for (const char* name : {"a", "b"})
    ASSERT_EQ(thermovox(folder.path(), fmt::format("map {0} --resolution 0.1 --station {0}.tvx", name)).code,
              0);
  const std::string merge = "merge a.tvx b.tvx --transform '-3 0.5 0 0 0 0.6 0.8' ";
  ASSERT_EQ(thermovox(folder.path(), merge + "-o roomy.tvx").code, 0);
  ASSERT_EQ(thermovox(folder.path(), merge + "--memory 1 --threads 2 -o narrow.tvx").code, 0);
  EXPECT_TRUE(bytesOf(folder / "narrow.tvx") == bytesOf(folder / "roomy.tvx"));
  EXPECT_EQ(thermovox(folder.path(), merge + "--memory 0 -o x.tvx").code, 2);
}

TEST(ExportMemory, AndThreadsDoNotChangeOneByteOfWhatIsExported) {
  const TestFolder folder;
  fly(folder, "a", 31);
  ASSERT_EQ(thermovox(folder.path(), "map a --resolution 0.05 --station a.tvx").code, 0);
  for (const std::string ending : {"ply", "bt", "ot"}) {
    ASSERT_EQ(thermovox(folder.path(), "export a.tvx roomy." + ending).code, 0);
    ASSERT_EQ(thermovox(folder.path(), "export a.tvx --memory 1 --threads 2 narrow." + ending).code, 0);
    EXPECT_TRUE(bytesOf(folder / ("narrow." + ending)) == bytesOf(folder / ("roomy." + ending))) << ending;
  }
  EXPECT_EQ(thermovox(folder.path(), "export a.tvx --memory 0 x.ply").code, 2);
}

TEST(Threads, AreOneForEachProcessorWhereZeroAreAskedForInEveryVerb) {
  const TestFolder folder;
  fly(folder, "a", 31);
  fly(folder, "b", 32);
  for (const char* name : {"a", "b"})
    ASSERT_EQ(thermovox(folder.path(), fmt::format("map {0} --threads 0 --station {0}.tvx", name)).code, 0);
  for (const char* verb : {"merge a.tvx b.tvx -o out.tvx", "export a.tvx out.ply", "map a --station x.tvx"}) {
    EXPECT_EQ(thermovox(folder.path(), fmt::format("{} --threads 0", verb)).code, 0) << verb;
    for (const int wrong : {-1, 1025}) {
      const Outcome refused = thermovox(folder.path(), fmt::format("{} --threads {}", verb, wrong));
      EXPECT_EQ(refused.code, 2) << verb;
      EXPECT_THAT(refused.err, testing::HasSubstr("expected 1 to 1024 (or 0 for all processors)"));
    }
  }
}

TEST(MapMemoryReport, TilesThatWaitInAFileAreToldOf) {
  const TestFolder folder;
  fly(folder, "a", 31);
  const Outcome roomy = thermovox(folder.path(), "map a --station roomy.tvx");
  const Outcome narrow = thermovox(folder.path(), "map a --station narrow.tvx --memory 1");
  EXPECT_THAT(roomy.out, testing::Not(testing::HasSubstr("--memory")));
  EXPECT_THAT(narrow.out, testing::HasSubstr("for want of memory: more --memory makes it faster"));
}

}  // namespace
}  // namespace thermovox::test
