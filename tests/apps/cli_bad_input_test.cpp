// Bad input, one kind a test: exit code 1, one line that names the file and the fault, and nothing left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fmt/format.h>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;

/// A mission whose files a test damages.
class BadInput : public testing::Test {
 protected:
  void fly(LaserKind laser = LaserKind::beam) { flyMission(folder_, "hall", laser); }
  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / "hall" / name; }
  void expectMapRefused(const std::vector<std::string>& words) const {
    expectRefused(folder_.path(), "map hall --station s.tvx --points p.csv", words);
  }
  /// The lines of a file, changed and written back.
  template <typename Change>
  void changeLines(const std::string& name, Change&& change) const {
    std::istringstream text(bytesOf(file(name)));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    change(lines);
    std::ofstream stream(file(name));
    for (const std::string& line : lines) stream << line << '\n';
  }
  [[nodiscard]] Outcome map() const { return thermovox(folder_.path(), "map hall --station s.tvx --json"); }

  TestFolder folder_;
};

TEST_F(BadInput, AMissionThatIsNotThere) {
  expectMapRefused({"hall", "no such mission"});
  fs::create_directory(folder_ / "hall");
  expectMapRefused({"hall/mission.yaml", "no such file"});
}

TEST_F(BadInput, AFileThatIsMissing) {
  for (const char* name : {"rig.yaml", "trajectory.tum", "thermal.csv", "clouds.csv", "clouds/000004.pcd",
                           "thermal/000002.tiff"}) {
    fly(LaserKind::cloud);
    fs::remove(file(name));
    expectMapRefused({name, "no such file"});
    fs::remove_all(folder_ / "hall");
    fs::remove(folder_ / "hall.truth.json");
  }
}

TEST_F(BadInput, AnImageOfAnotherSizeThanTheRigs) {
  fly();
  replaceIn(file("rig.yaml"), "width: 160", "width: 161");
  expectMapRefused({"000000.tiff", "160 x 120", "expected 161 x 120"});
}

TEST_F(BadInput, ALaserOfUnknownKind) {
  fly();
  replaceIn(file("rig.yaml"), "kind: beam", "kind: sonar");
  expectMapRefused({"rig.yaml", "sonar", "beam, scan or cloud"});
}

TEST_F(BadInput, NaNInTheRig) {
  fly();
  replaceIn(file("rig.yaml"), "fx: ", "fx: .nan #");
  expectMapRefused({"rig.yaml", "fx"});
}

TEST_F(BadInput, NaNInTheTrajectory) {
  fly();
  changeLines("trajectory.tum", [](auto& lines) {
    const std::string stamp = lines[20].substr(0, lines[20].find(' '));
    lines[20] = stamp + " nan 0 1 0 0 0 1";
  });
  expectMapRefused({"trajectory.tum:21", "nan", "finite"});
}

TEST_F(BadInput, NaNAmongTheRangesIsNoReturnAndNoFault) {
  fly();
  changeLines("beam.csv", [](auto& lines) {
    for (std::size_t i = 10; i < 15; ++i) lines[i] = lines[i].substr(0, lines[i].find(',')) + ",nan";
  });
  const Outcome outcome = map();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("dropped").at("no_return"), 5);
}

/// The line with its quaternion times a factor.
std::string scaled(const std::string& line, double factor) {
  std::istringstream text(line);
  std::string result;
  std::string word;
  for (int i = 0; text >> word; ++i) {
    if (i > 0) result += ' ';
    result += i < 4 ? word : fmt::format("{:.9f}", factor * std::stod(word));
  }
  return result;
}

TEST_F(BadInput, AQuaternionWhoseNormIsOffByMoreThanAPercent) {
  fly();
  const std::string sound = bytesOf(file("trajectory.tum"));
  for (const double factor : {1.011, 0.989, 2.0, 0.0}) {
    changeLines("trajectory.tum", [&](auto& lines) { lines[30] = scaled(lines[30], factor); });
    expectMapRefused({"trajectory.tum:31", "norm", "1 within 1 %"});
    folder_.write("hall/trajectory.tum", sound);
  }
  replaceIn(file("rig.yaml"), "quaternion_xyzw: [", "quaternion_xyzw: [3");
  expectMapRefused({"rig.yaml", "norm", "1 within 1 %"});
}

TEST_F(BadInput, AQuaternionThatIsOffByLessIsNormalised) {
  fly();
  const std::string line = std::string("map hall --resolution 0.1 --points ");
  ASSERT_EQ(thermovox(folder_.path(), line + "sound.csv --station 1.tvx").code, 0);
  changeLines("trajectory.tum", [](auto& lines) {
    for (std::string& pose : lines) {
      if (!pose.starts_with('#')) pose = scaled(pose, 1.009);
    }
  });
  ASSERT_EQ(thermovox(folder_.path(), line + "scaled.csv --station 2.tvx").code, 0);
  std::istringstream sound(bytesOf(folder_ / "sound.csv")), normalised(bytesOf(folder_ / "scaled.csv"));
  std::string a, b;
  while (std::getline(sound, a) && std::getline(normalised, b)) {
    if (a.starts_with('t')) continue;
    double stamp_a = 0, x_a = 0, y_a = 0, stamp_b = 0, x_b = 0, y_b = 0;
    ASSERT_EQ(std::sscanf(a.c_str(), "%lf,%lf,%lf", &stamp_a, &x_a, &y_a), 3);
    ASSERT_EQ(std::sscanf(b.c_str(), "%lf,%lf,%lf", &stamp_b, &x_b, &y_b), 3);
    ASSERT_EQ(stamp_a, stamp_b);
    ASSERT_NEAR(x_a, x_b, 2e-4);
    ASSERT_NEAR(y_a, y_b, 2e-4);
  }
}

TEST_F(BadInput, TimesOfATrajectoryThatDoNotAscend) {
  fly();
  const std::string sound = bytesOf(file("trajectory.tum"));
  changeLines("trajectory.tum", [](auto& lines) { std::swap(lines[40], lines[41]); });
  expectMapRefused({"trajectory.tum:42", "ascending"});
  folder_.write("hall/trajectory.tum", sound);
  changeLines("trajectory.tum", [](auto& lines) { lines.insert(lines.begin() + 40, lines[40]); });
  expectMapRefused({"trajectory.tum:42", "ascending"});
}

TEST_F(BadInput, AnEmptyMission) {
  fly();
  folder_.write("hall/beam.csv", "timestamp,range,strength\n");
  expectMapRefused({"hall/mission.yaml", "empty"});
  folder_.write("hall/trajectory.tum", "# timestamp tx ty tz qx qy qz qw\n");
  expectMapRefused({"trajectory.tum", "no pose"});
  folder_.write("hall/mission.yaml", "");
  expectMapRefused({"mission.yaml"});
}

TEST_F(BadInput, ATruncatedImage) {
  fly();
  const std::string sound = bytesOf(file("thermal/000002.tiff"));
  for (const double share : {0.0, 0.001, 0.3, 0.95}) {
    folder_.write("hall/thermal/000002.tiff", sound);
    truncateTo(file("thermal/000002.tiff"), share);
    expectMapRefused({"000002.tiff"});
  }
}

TEST_F(BadInput, ATruncatedCloud) {
  fly(LaserKind::cloud);
  const std::string sound = bytesOf(file("clouds/000005.pcd"));
  for (const double share : {0.0, 0.0005, 0.5, 0.999}) {
    folder_.write("hall/clouds/000005.pcd", sound);
    truncateTo(file("clouds/000005.pcd"), share);
    expectMapRefused({"000005.pcd"});
  }
}

TEST_F(BadInput, ATrajectoryThatCoversNoneOfTheReadings) {
  fly();
  folder_.write("hall/trajectory.tum", "100 0 0 1 0 0 0 1\n100.1 0 0 1 0 0 0 1\n");
  expectMapRefused({"mission hall", "trajectory covers none of its 100 readings", "after_trajectory 100"});
}

TEST_F(BadInput, ATrajectoryThatCoversSomeReadingsDropsAndCountsTheRest) {
  fly();
  const auto all = map();
  ASSERT_EQ(all.code, 0) << all.err;
  fs::remove(folder_ / "s.tvx");
  changeLines("trajectory.tum", [](auto& lines) { lines.resize(lines.size() / 2); });
  const Outcome outcome = map();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  const int dropped = json.at("dropped").at("after_trajectory");
  EXPECT_GT(dropped, 30);
  EXPECT_EQ(json.at("points").get<int>() + dropped, all.json().at("points").get<int>());
}

TEST_F(BadInput, AFullDisk) {
  fly(LaserKind::cloud);
  const std::string limited = fmt::format("ulimit -f 120; trap '' XFSZ; {}", kThermovox);  // 60 kB a file
  const std::set<std::string> before = namesUnder(folder_.path());
  const auto refused = [&](const std::string& arguments, const std::string& file) {
    SCOPED_TRACE(arguments);
    expectOneLineOfError(runShell(folder_.path(), limited + arguments), {file});
  };
  refused("map hall --station s.tvx", "s.tvx");
  refused("map hall --station s.tvx --points p.csv", "p.csv");
  refused("simulate more --laser scan --duration 0.5", "more");
  EXPECT_EQ(namesUnder(folder_.path()), before);
  ASSERT_EQ(map().code, 0);
  const std::set<std::string> with_station = namesUnder(folder_.path());
  for (const char* name : {"map.ply", "map.pcd", "map.las", "map.csv", "map.bt", "map.ot", "map.png"}) {
    refused(std::string("export s.tvx ") + name, name);
  }
  refused("overlay hall pictures", "pictures");
  EXPECT_EQ(namesUnder(folder_.path()), with_station);
}

TEST_F(BadInput, AFullDiskLeavesAnExistingStationWhole) {
  fly(LaserKind::scan);
  flyMission(folder_, "second", LaserKind::cloud, 12);
  ASSERT_EQ(map().code, 0);
  const std::string station = bytesOf(folder_ / "s.tvx");
  const std::string blocks = std::to_string(station.size() / 512 + 8);
  const std::set<std::string> before = namesUnder(folder_.path());
  expectOneLineOfError(runShell(folder_.path(), "ulimit -f " + blocks + "; trap '' XFSZ; " + kThermovox +
                                                    "map second --station s.tvx"),
                       {"s.tvx"});
  EXPECT_EQ(namesUnder(folder_.path()), before);
  EXPECT_TRUE(bytesOf(folder_ / "s.tvx") == station);
}

TEST_F(BadInput, ATinyFilesystemThatIsReallyFull) {
  fly(LaserKind::cloud);
  fs::create_directory(folder_ / "tiny");
  // In a namespace of its own, so that the mount goes with the shell.
  const auto onTinyDisk = [&](const std::string& line) {
    return runShell(folder_.path(),
                    "unshare -m sh -c \"mount -t tmpfs -o size=64k none tiny && { " + line + " }\"");
  };
  if (::geteuid() != 0 || onTinyDisk("true;").code != 0)
    GTEST_SKIP() << "a small disk cannot be mounted here";
  for (const std::string arguments : {"map hall --station tiny/s.tvx", "map hall --points tiny/p.csv"}) {
    const Outcome outcome =
        onTinyDisk(kThermovox + arguments + "; code=\\$?; ls -A tiny >left; exit \\$code;");
    expectOneLineOfError(outcome, {"tiny/"});
    EXPECT_EQ(bytesOf(folder_ / "left"), "");
    EXPECT_FALSE(fs::exists(folder_ / "hall.tvx"));
  }
}

}  // namespace
}  // namespace thermovox::test
