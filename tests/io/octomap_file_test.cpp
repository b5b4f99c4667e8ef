#include "io/octomap_file.hpp"

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <sstream>

#include "mapping/octomap_adapter.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

/// Calls visit(key, occupied) for all known cells.
template <typename Visitor>
void forEachKnownCell(const ThermalMap& map, Visitor&& visit) {
  for (const BlockKey& block : map.sortedBlockKeys()) {
    for (int i = 0; i < kBlockCells; ++i) {
      const Occupancy state = map.occupancy(cellAt(block, i));
      if (state != Occupancy::unknown) visit(cellAt(block, i), state == Occupancy::occupied);
    }
  }
}

TEST(OctomapFile, BtHoldsTheStateOfEveryCell) {
  const test::TestFolder folder;
  const ThermalMap map = test::randomMission(7);
  writeBt(folder / "map.bt", map, Existing::refuse);
  octomap::OcTree tree((folder / "map.bt").string());
  EXPECT_EQ(tree.getResolution(), map.resolution());
  std::size_t cells = 0;
  forEachKnownCell(map, [&](const CellKey& key, bool occupied) {
    const Eigen::Vector3d p = map.centerOf(key);
    const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
    ASSERT_NE(node, nullptr);
    ASSERT_EQ(tree.isNodeOccupied(node), occupied);
    ++cells;
  });
  tree.expand();
  EXPECT_EQ(tree.getNumLeafNodes(), cells);
}

TEST(OctomapFile, BtHasTheBytesOfOctomapsOwnWriter) {
  const test::TestFolder folder;
  const ThermalMap map = test::randomMission(9);
  writeBt(folder / "map.bt", map, Existing::refuse);
  std::ostringstream expected;
  ASSERT_TRUE(toOcTree(map)->writeBinary(expected));
  EXPECT_TRUE(test::bytesOf(folder / "map.bt") == expected.str());
}

TEST(OctomapFile, OtHoldsTheColoursOfTheSurface) {
  const test::TestFolder folder;
  const ThermalMap map = test::randomMission(8);
  const ColourScale scale{Palette::ironbow, TemperatureSpan{10.0, 90.0}};
  writeOt(folder / "map.ot", map, scale, Existing::refuse);
  const std::unique_ptr<octomap::AbstractOcTree> read(
      octomap::AbstractOcTree::read((folder / "map.ot").string()));
  const auto* tree = dynamic_cast<octomap::ColorOcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    const Eigen::Vector3d p = map.centerOf(key);
    const octomap::ColorOcTreeNode::Color color = tree->search(p.x(), p.y(), p.z())->getColor();
    const Rgb expected =
        cell.observations > 0 ? colourOf(cell.mean(), *scale.span, scale.palette) : kUnknownColour;
    ASSERT_EQ((Rgb{color.r, color.g, color.b}), expected);
  });
  for (auto node = tree->begin_tree(); node != tree->end_tree(); ++node) ASSERT_TRUE(node->isColorSet());
}

TEST(OctomapFile, LeavesNothingBehindWhenTheMapDoesNotFit) {
  const test::TestFolder folder;
  ThermalMap map({.resolution = 0.1});
  map.integrate(std::vector<MappedReturn>{{{5000.0, 0.0, 0.0}, {5000.0, 0.0, 1.0}, Time{}, {}}},
                Carving::none);
  EXPECT_THROW(writeBt(folder / "map.bt", map, Existing::refuse), DataError);
  EXPECT_THROW(writeOt(folder / "map.ot", map, {}, Existing::refuse), DataError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(OctomapFile, RefusesFilesThatAreThere) {
  const test::TestFolder folder;
  folder.write("map.bt", "mine");
  EXPECT_THROW(writeBt(folder / "map.bt", test::randomMission(1), Existing::refuse), DataError);
  EXPECT_EQ(test::bytesOf(folder / "map.bt"), "mine");
}

}  // namespace
}  // namespace thermovox
