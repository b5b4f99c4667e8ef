#include "io/asset_file.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "projection/error.hpp"
#include "tests/io/readme_example.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The assets that io/README.md shows.
std::string example() {
  return test::readmeExample("assets:\n");
}

std::string with(std::string_view old_part, std::string_view new_part) {
  return test::replaced(example(), old_part, new_part);
}

std::string complaintAbout(const std::string& text) {
  return test::messageOf<ConfigError>([&] { static_cast<void>(parseAssets(text, "a.yaml")); });
}

TEST(AssetFile, ReadsTheExampleOfTheReadme) {
  const test::TestFolder folder;
  const Assets assets = readAssets(folder.write("assets.yaml", example()));
  ASSERT_EQ(assets.size(), 3U);
  EXPECT_EQ(assets[0].name, "transformer 1, bushing A");
  EXPECT_TRUE(assets[0].size.isApprox(Eigen::Vector3d(0.6, 0.6, 2.2)));
  EXPECT_TRUE(assets[0].T_world_box.translation.isApprox(Eigen::Vector3d(12.3, 3.3, 3.1)));
  EXPECT_EQ(assets[0].limits.above, 80.0);
  EXPECT_EQ(assets[0].limits.delta, 5.0);
  EXPECT_FALSE(assets[0].emissivity);
  EXPECT_FALSE(assets[1].limits.above);
  EXPECT_THAT(assets.twinsOf(0), testing::ElementsAre(1U));
  EXPECT_EQ(assets[2].emissivity, 0.3);
  EXPECT_EQ(assets[2].twin_group, "");
  EXPECT_EQ(assets.at({15.9, 3.2, 5.1}), 2U);
  EXPECT_EQ(assets.at({12.0, 3.0, 2.0}), 0U);
}

TEST(AssetFile, YawTurnsABoxAboutItsMiddleCounterClockwise) {
  const Assets assets =
      parseAssets("assets: {name: a, min: [0, 0, 0], max: [4, 2, 1], yaw_deg: 30}", "a.yaml");
  const Eigen::Vector3d middle(2.0, 1.0, 0.5);
  const Eigen::Vector3d along(std::sqrt(0.75), 0.5, 0.0);  // the long axis, turned
  EXPECT_TRUE(assets.at(middle + 1.99 * along));
  EXPECT_FALSE(assets.at(middle + 2.01 * along));
  EXPECT_FALSE(assets.at({0.05, 1.9, 0.5}));  // within the box as it was before it was turned
}

TEST(AssetFile, ComplaintsNameFileKeyAndWhatWasExpected) {
  EXPECT_THAT(complaintAbout("assets: []"), HasSubstr("a.yaml, assets: names none, expected one at least"));
  EXPECT_THAT(complaintAbout("{}"), HasSubstr("a.yaml, assets: names none"));
  EXPECT_THAT(complaintAbout(with("bushing B", "bushing A")),
              HasSubstr("a.yaml, assets[1].name: 'transformer"));
  EXPECT_THAT(complaintAbout(with("max: [12.6", "max: [12.0")),
              AllOf(HasSubstr("a.yaml, assets[0].max: has 12 where min has 12"), HasSubstr("every axis")));
  EXPECT_THAT(complaintAbout(with("min: [12.0, 3.0, 2.0]", "min: [12.0, 3.0]")),
              HasSubstr("a.yaml, assets[0].min: has 2 numbers, expected 3"));
  EXPECT_THAT(complaintAbout(with("min: [12.0,", "min: [.nan,")), HasSubstr("expected a finite number"));
  EXPECT_THAT(complaintAbout(with("    min: [12.0, 3.0, 2.0]\n", "")),
              HasSubstr("assets[0].min: is missing"));
  EXPECT_THAT(complaintAbout(with("yaw_deg", "yaw")),
              AllOf(HasSubstr("a.yaml, assets[1]: unknown key 'yaw'"), HasSubstr("yaw_deg")));
  EXPECT_THAT(complaintAbout(with("size: [4.0", "yaw_deg: 3\n    size: [4.0")),
              HasSubstr("assets[2].yaw_deg: is given beside pose"));
  EXPECT_THAT(complaintAbout(with("yaw_deg: 30", "size: [1, 1, 1]")), HasSubstr("beside min and max"));
  EXPECT_THAT(complaintAbout(with("size: [4.0", "size: [-4.0")),
              HasSubstr("assets[2].size: has an edge of -4"));
  EXPECT_THAT(complaintAbout(with("[0, 0, 0, 1]", "[0, 0, 0, 2]")),
              HasSubstr("assets[2].pose.quaternion_xyzw: the quaternion"));
  EXPECT_THAT(complaintAbout(with("emissivity: 0.3", "emissivity: 30")),
              HasSubstr("assets[2].emissivity: is 30"));
  EXPECT_THAT(complaintAbout(with("delta: 5", "delta: 0")), HasSubstr("assets[0].limits.delta: is 0"));
  EXPECT_THAT(complaintAbout(with("above: 80", "over: 80")),
              HasSubstr("assets[0].limits: unknown key 'over'"));
  EXPECT_THAT(complaintAbout(with("twin_group: transformer 1, b", "twin_group: transformer 2, b")),
              HasSubstr("assets[0].twin_group: no other asset is of 'transformer 2, bushings'"));
  EXPECT_THAT(complaintAbout(with("name: bus bar", "name: \"bus\\x07bar\"")), HasSubstr("printable UTF-8"));
}

TEST(AssetFile, RefusesFilesThatAreCutOffOrNotThere) {
  const std::string whole = example();
  for (std::size_t length = 0; length + 2 < whole.size(); length += 7) {
    try {
      static_cast<void>(parseAssets(whole.substr(0, length), "a.yaml"));  // what is left may be sound
    } catch (const ConfigError&) {
    }
  }
  EXPECT_THROW(static_cast<void>(readAssets("/no/such/assets.yaml")), DataError);
}

}  // namespace
}  // namespace thermovox
