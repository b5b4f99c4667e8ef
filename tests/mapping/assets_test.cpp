#include "mapping/assets.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "projection/error.hpp"

namespace thermovox {
namespace {

Asset box(std::string name, const Eigen::Vector3d& middle, const Eigen::Vector3d& size) {
  Asset asset{.name = std::move(name), .size = size};
  asset.T_world_box.translation = middle;
  return asset;
}

TEST(Assets, APlaceBelongsToTheSmallestBoxAndOfEqualOnesToTheFirst) {
  const Assets assets({box("hall", {0, 0, 0}, {20, 20, 20}), box("left", {-1, 0, 0}, {2, 2, 2}),
                       box("right", {1, 0, 0}, {2, 2, 2}), box("joint", {1, 0, 0}, {0.2, 0.2, 0.2})});
  EXPECT_EQ(assets.at({5, 5, 5}), 0U);
  EXPECT_EQ(assets.at({-0.5, 0, 0}), 1U);
  EXPECT_EQ(assets.at({0, 0, 0}), 1U);  // on the border of both
  EXPECT_EQ(assets.at({0.5, 0, 0}), 2U);
  EXPECT_EQ(assets.at({1.05, 0, 0}), 3U);
  EXPECT_EQ(assets.at({10, 10, 10}), 0U);
  EXPECT_FALSE(assets.at({10.001, 0, 0}));
  EXPECT_FALSE(assets.at({std::nan(""), 0, 0}));
  EXPECT_FALSE(Assets().at({0, 0, 0}));
}

TEST(Assets, ATurnedBoxMeasuresAlongItsOwnAxes) {
  Asset asset = box("bar", {3, 2, 1}, {4, 0.2, 0.2});
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  asset.T_world_box.rotation = Eigen::AngleAxisd(1.1, axis);
  const Eigen::Vector3d along = asset.T_world_box.rotation * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(asset.holds(Eigen::Vector3d(3, 2, 1) + 1.999 * along));
  EXPECT_NEAR(asset.distanceTo(Eigen::Vector3d(3, 2, 1) + 2.5 * along), 0.5, 1e-12);
}

TEST(Assets, CellsHaveTheAssetOfTheirCentres) {
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> place(-15.0, 15.0), edge(0.1, 8.0), angle(0.0, std::numbers::pi);
  std::vector<Asset> boxes;
  for (int i = 0; i < 40; ++i) {
    boxes.push_back(
        box(std::to_string(i), {place(rng), place(rng), place(rng)}, {edge(rng), edge(rng), edge(rng)}));
    boxes.back().T_world_box.rotation = Eigen::AngleAxisd(angle(rng), Eigen::Vector3d::UnitZ());
  }
  const Assets assets(boxes);
  CellAssets cells(assets, 0.05);
  std::uniform_int_distribution<int> key(-330, 330);
  std::size_t held = 0;
  for (int i = 0; i < 20000; ++i) {
    const CellKey cell{key(rng), key(rng), key(rng)};
    const Eigen::Vector3d centre((cell.x + 0.5) * 0.05, (cell.y + 0.5) * 0.05, (cell.z + 0.5) * 0.05);
    const auto expected = assets.at(centre);
    ASSERT_EQ(cells.at(cell), expected);
    held += expected.has_value() ? 1 : 0;
  }
  EXPECT_GT(held, 1000U);
}

TEST(Assets, AHotSpotBelongsWhereItsPeakIsOrElseMostOfItsCells) {
  const Assets assets({box("a", {0, 0, 0}, {2, 2, 2}), box("b", {3, 0, 0}, {2, 2, 2})});
  Hotspot spot;
  spot.position.p_world = {0.9, 0, 0};
  spot.cells = {{20, 0, 0}, {21, 0, 0}};  // of 0.1 m, in b
  EXPECT_EQ(assets.of(spot, 0.1), 0U);
  spot.position.p_world = {1.5, 0, 0};
  EXPECT_EQ(assets.of(spot, 0.1), 1U);
  spot.cells = {{9, 0, 0}, {20, 0, 0}, {15, 0, 0}};
  EXPECT_EQ(assets.of(spot, 0.1), 0U);  // one each
  spot.cells = {{15, 0, 0}};
  EXPECT_FALSE(assets.of(spot, 0.1));
}

TEST(Assets, TwinsAreTheOthersOfTheGroup) {
  std::vector<Asset> boxes;
  for (const char* name : {"A", "x", "B", "C"}) boxes.push_back(box(name, {0, 0, 0}, {1, 1, 1}));
  for (const std::size_t i : {0U, 2U, 3U}) boxes[i].twin_group = "phases";
  const Assets assets(boxes);
  EXPECT_THAT(assets.twinsOf(2), testing::ElementsAre(0U, 3U));
  EXPECT_THAT(assets.twinsOf(1), testing::IsEmpty());
}

TEST(Assets, RefusesWhatCannotBe) {
  const auto refused = [](auto&& spoil) {
    std::vector<Asset> boxes{box("a", {0, 0, 0}, {1, 1, 1}), box("b", {0, 0, 0}, {1, 1, 1})};
    spoil(boxes[1]);
    EXPECT_THROW(Assets{boxes}, ConfigError);
  };
  refused([](Asset& one) { one.name.clear(); });
  refused([](Asset& one) { one.name = "a"; });
  refused([](Asset& one) { one.size.y() = 0.0; });
  refused([](Asset& one) { one.size.z() = std::nan(""); });
  refused([](Asset& one) { one.size.z() = INFINITY; });
  refused([](Asset& one) { one.T_world_box.translation.x() = INFINITY; });
  refused([](Asset& one) { one.emissivity = 0.0; });
  refused([](Asset& one) { one.emissivity = 1.01; });
  refused([](Asset& one) { one.limits.above = std::nan(""); });
  refused([](Asset& one) { one.limits.delta = -1.0; });
  refused([](Asset& one) { one.twin_group = "alone"; });
}

}  // namespace
}  // namespace thermovox
