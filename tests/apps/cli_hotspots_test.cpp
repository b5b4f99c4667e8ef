#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

/// A second of a flight, mapped with wide cells.
class CliHotspots : public testing::Test {
 protected:
  void SetUp() override {
    flyMission(folder, "hall", LaserKind::cloud);
    ASSERT_EQ(thermovox(folder.path(), "map hall --station s.tvx --resolution 0.1").code, 0);
  }
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return thermovox(folder.path(), arguments);
  }
  TestFolder folder;
};

TEST_F(CliHotspots, ATableIsNotWrittenOverAStation) {
  const std::string before = bytesOf(folder / "s.tvx");
  EXPECT_EQ(run("hotspots s.tvx --csv s.tvx --force").code, 2);
  EXPECT_EQ(bytesOf(folder / "s.tvx"), before);
  EXPECT_EQ(run("hotspots s.tvx --csv t.csv").code, 0);
  EXPECT_EQ(run("hotspots s.tvx --csv t.csv").code, 1);
}

TEST_F(CliHotspots, WhatCannotBeIsWrongUsage) {
  for (const char* bad : {"--ambient nan", "--ambient inf", "--delta -3", "--delta nan", "--above inf",
                          "--assumed-emissivity 0", "--assumed-emissivity nan"}) {
    EXPECT_EQ(run(std::string("hotspots s.tvx ") + bad).code, 2) << bad;
  }
  EXPECT_EQ(run("diff s.tvx --from hall --to nobody").code, 1);
}

TEST_F(CliHotspots, AssetsWithAnEmissivityAreCorrectedForItWhereItIsKnownWhatWasAssumed) {
  folder.write("assets.yaml",
               "assets:\n  - {name: all, min: [-50, -50, -5], max: [50, 50, 20], emissivity: 0.5}\n");
  const Outcome warned = run("hotspots s.tvx --delta 3 --json --assets assets.yaml");
  ASSERT_EQ(warned.code, 0) << warned.err;
  EXPECT_THAT(warned.err, testing::HasSubstr("--assumed-emissivity"));
  const auto plain = nlohmann::json::parse(warned.out);
  const Outcome corrected =
      run("hotspots s.tvx --delta 3 --json --assets assets.yaml --assumed-emissivity 0.95");
  EXPECT_EQ(corrected.err, "");
  const auto json = nlohmann::json::parse(corrected.out);
  ASSERT_EQ(json["assets"].size(), 1U);
  EXPECT_TRUE(json["assets"][0]["corrected"]);
  EXPECT_FALSE(plain["assets"][0]["corrected"]);
  EXPECT_GT(json["assets"][0]["max"], plain["assets"][0]["max"]);
}

}  // namespace
}  // namespace thermovox::test
