#include "mapping/octomap_adapter.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

using test::randomMission;

const octomap::ColorOcTreeNode::Color kGrey(128, 128, 128);

/// Occupancy alone: block by block.
void expectSameOccupancy(const ThermalMap& a, const ThermalMap& b) {
  ASSERT_EQ(a.options(), b.options());
  ASSERT_EQ(a.sortedBlockKeys(), b.sortedBlockKeys());
  for (const BlockKey& key : a.sortedBlockKeys())
    ASSERT_TRUE(a.block(key)->log_odds == b.block(key)->log_odds);
}

TEST(OctomapAdapter, RoundTripsTheOccupancyBitForBit) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const ThermalMap map = randomMission(seed);
    expectSameOccupancy(fromOcTree(*toOcTree(map)), map);
  }
}

TEST(OctomapAdapter, RoundTripsOtherSensorModels) {
  ThermalMap map({.resolution = 0.2, .occupancy = {0.8, 0.35, 0.05, 0.98, 0.6}});
  for (int i = 0; i < 7; ++i) {
    map.integrate(std::vector<MappedReturn>{{{1.0 + 0.3 * i, 2.0, 0.5}, {0, 0, 0}, Time{}, {}}},
                  Carving::octomap);
  }
  expectSameOccupancy(fromOcTree(*toOcTree(map)), map);
}

/// Whether the map and a tree take the same cells of one block for occupied.
void expectSameStates(const ThermalMap& map, const octomap::OcTree& tree) {
  for (int index = 0; index < kBlockCells; ++index) {
    const CellKey cell = cellAt({0, 0, 0}, index);
    if (map.occupancy(cell) == Occupancy::unknown) continue;
    const Eigen::Vector3d p = map.centerOf(cell);
    EXPECT_EQ(tree.isNodeOccupied(tree.search(p.x(), p.y(), p.z())),
              map.occupancy(cell) == Occupancy::occupied)
        << *map.logOdds(cell) << ", threshold " << map.options().occupancy.occupied;
  }
}

TEST(OctomapAdapter, AgreesWithItsTreesOnWhatIsOccupied) {
  for (int i = 15; i <= 95; ++i) {
    ThermalMap map({.resolution = 0.1, .occupancy = {.occupied = i / 100.0}});
    Block block;
    const OccupancyModel& model = map.occupancyModel();
    for (int quanta = model.clampMin(); quanta <= model.clampMax(); ++quanta) {
      block.log_odds.set(quanta - model.clampMin(), static_cast<LogOdds>(quanta));
    }
    map.setBlock({0, 0, 0}, block);
    const auto tree = toOcTree(map);
    expectSameStates(map, *tree);
    const ThermalMap again = fromOcTree(*tree);
    expectSameOccupancy(again, map);
    expectSameStates(again, *tree);
  }
}

TEST(OctomapAdapter, ClampsWhatOtherTreesHoldAndNeverMakesItUnknown) {
  octomap::OcTree tree(0.1);
  const std::vector<std::pair<float, int>> leaves{{1e30F, 95},     {-1e30F, -54}, {5.0F, 95}, {-1207.0F, -54},
                                                  {-1207.1F, -54}, {0.0F, 0},     {0.11F, 3}};
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    tree.setNodeValue(0.2 * static_cast<double>(i) + 0.05, 0.05, 0.05, 0.0F, true)
        ->setLogOdds(leaves[i].first);
  }
  const ThermalMap map = fromOcTree(tree);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const CellKey cell{2 * static_cast<std::int32_t>(i), 0, 0};
    EXPECT_EQ(map.block(blockOf(cell))->log_odds[indexInBlock(cell)], leaves[i].second) << leaves[i].first;
  }
}

TEST(OctomapAdapter, RefusesLogOddsThatAreNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    octomap::OcTree tree(0.1);
    tree.setNodeValue(0.05, 0.05, 0.05, 1.0F, true)->setLogOdds(bad);
    EXPECT_NE(test::messageOf<DataError>([&] { (void)fromOcTree(tree); }).find("finite"), std::string::npos);
  }
}

TEST(OctomapAdapter, PrunesAndExpandsAgain) {
  ThermalMap map({.resolution = 0.1});
  Block block;
  block.log_odds.fill(-54);
  map.setBlock({0, 0, 0}, block);
  const auto tree = toOcTree(map);
  EXPECT_EQ(tree->getNumLeafNodes(), 1U);
  expectSameOccupancy(fromOcTree(*tree), map);
}

TEST(OctomapAdapter, UpdatesInnerNodes) {
  ThermalMap map({.resolution = 0.1});
  map.integrate(std::vector<MappedReturn>{{{1.05, 0.05, 0.05}, {0.05, 0.05, 0.05}, Time{}, {}}},
                Carving::octomap);
  const auto tree = toOcTree(map);
  EXPECT_TRUE(tree->isNodeOccupied(tree->getRoot()));  // the root is as occupied as its likeliest leaf
  EXPECT_NEAR(tree->search(1.05, 0.05, 0.05)->getLogOdds(), *map.logOdds({10, 0, 0}), 1e-6);
  EXPECT_EQ(tree->search(1.15, 0.05, 0.05), nullptr);
}

TEST(OctomapAdapter, RefusesCellsBeyondOctomapsKeys) {
  ThermalMap map({.resolution = 0.1});
  map.integrate(std::vector<MappedReturn>{{{4000.0, 0.0, 0.0}, {4000.0, 0.0, 1.0}, Time{}, {}}},
                Carving::none);
  EXPECT_NE(test::messageOf<DataError>([&] { (void)toOcTree(map); }).find("local origin"), std::string::npos);
}

TEST(OctomapAdapter, RefusesTreesThatDoNotFitUnpruned) {
  // A root without children stands for all 2^48 cells.
  std::string file = "# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n";
  file += std::string("\0\0\x80\x3f\0", 5);  // log-odds 1.0F, no children
  std::istringstream stream(file);
  const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(stream));
  ASSERT_NE(tree, nullptr);
  EXPECT_THROW((void)fromOcTree(dynamic_cast<octomap::OcTree&>(*tree)), DataError);
}

TEST(OctomapAdapter, GivesAnEmptyTreeForAnEmptyMap) {
  const ThermalMap map({.resolution = 0.1});
  EXPECT_EQ(toOcTree(map)->size(), 0U);
  EXPECT_EQ(fromOcTree(*toOcTree(map)).blockCount(), 0U);
}

TEST(OctomapAdapter, PruningDoesNotSmearColours) {
  ThermalMap map({.resolution = 0.1});
  Block block;
  block.log_odds.fill(95);
  for (int i = 0; i < kBlockCells; ++i) {
    const TemperatureObservation seen{i == 77 ? 120.0F : 20.0F, 0.1F, 1.0F, 0.0F};
    block.surfaceOrNew(i).addTemperature(seen, Time{});
  }
  map.setBlock({0, 0, 0}, block);
  const auto tree = toColorOcTree(
      map,
      [](const SurfaceCell& cell) {
        const auto level = static_cast<std::uint8_t>(std::lround(cell.mean()));
        return octomap::ColorOcTreeNode::Color(level, level, level);
      },
      kGrey);
  const CellKey hot = cellAt({0, 0, 0}, 77);
  const Eigen::Vector3d p = map.centerOf(hot);
  EXPECT_EQ(tree->search(p.x(), p.y(), p.z())->getColor().r, 120);
  EXPECT_EQ(tree->search(0.75, 0.75, 0.75)->getColor().r, 20);
  EXPECT_LT(tree->getNumLeafNodes(), 64U);  // but equal ones are pruned
}

TEST(OctomapAdapter, EveryNodeHasAColour) {
  ThermalMap map({.resolution = 0.1});
  map.integrate(std::vector<MappedReturn>{{{1.05, 0.05, 0.05}, {0.05, 0.05, 0.05}, Time{}, {}}},
                Carving::octomap);
  const octomap::ColorOcTreeNode::Color hot(200, 100, 0);
  const auto tree = toColorOcTree(
      map, [&](const SurfaceCell&) { return hot; }, kGrey);
  EXPECT_EQ(tree->search(1.05, 0.05, 0.05)->getColor(), hot);
  EXPECT_EQ(tree->search(0.45, 0.05, 0.05)->getColor(), kGrey);  // free
  EXPECT_EQ(tree->getRoot()->getColor(), hot);                   // not thinned by the free cells below
  for (auto node = tree->begin_tree(); node != tree->end_tree(); ++node) EXPECT_TRUE(node->isColorSet());
}

TEST(OctomapAdapter, ColourTreesSurviveTheirFile) {
  const ThermalMap map = randomMission(5);
  const auto tree = toColorOcTree(
      map, [](const SurfaceCell&) { return octomap::ColorOcTreeNode::Color(1, 2, 3); }, kGrey);
  std::stringstream file;
  tree->write(file);
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(file));
  const auto* again = dynamic_cast<octomap::ColorOcTree*>(read.get());
  ASSERT_NE(again, nullptr);
  EXPECT_EQ(again->size(), tree->size());
}

}  // namespace
}  // namespace thermovox
