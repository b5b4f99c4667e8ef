#pragma once

#include <Eigen/Core>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace thermovox {

/// Index of a cubic cell of the map: cell k covers [k, k + 1) * resolution on each axis of the world.
struct CellKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  friend auto operator<=>(const CellKey&, const CellKey&) = default;
};

/// The largest |key| a map holds; further out a coordinate does not fit (1678 km at 0.05 m).
inline constexpr std::int32_t kMaxCellKey = 1 << 25;

/// OctoMap's keys have 16 bits: its maps end this many cells from the origin.
inline constexpr std::int32_t kOctomapReach = 1 << 15;

/// A coordinate as the map takes it, metres: rounded to 32-bit float within OctoMap's reach, because
/// OctoMap's points are floats and a laser that flies at exactly 0.7 m must hit the same cells in both.
/// Further out a float would be coarser than a cell, so there the double stays.
[[nodiscard]] inline double mapCoordinate(double coordinate, double inverse_resolution) {
  const bool near = std::abs(coordinate * inverse_resolution) < kOctomapReach;
  return near ? static_cast<double>(static_cast<float>(coordinate)) : coordinate;
}

/// Index along one axis of the cell that holds a coordinate (metres): floor(x / resolution), computed as
/// OctoMap does, as a product with the inverse.
[[nodiscard]] inline std::int32_t cellIndex(double coordinate, double inverse_resolution) {
  return static_cast<std::int32_t>(
      std::floor(inverse_resolution * mapCoordinate(coordinate, inverse_resolution)));
}

/// The cell that holds p_world (metres). Precondition: finite and within kMaxCellKey.
[[nodiscard]] inline CellKey cellKey(const Eigen::Vector3d& p_world, double inverse_resolution) {
  return {cellIndex(p_world.x(), inverse_resolution), cellIndex(p_world.y(), inverse_resolution),
          cellIndex(p_world.z(), inverse_resolution)};
}

/// Cells are kept in blocks of 8 x 8 x 8.
inline constexpr int kBlockBits = 3;
inline constexpr int kBlockEdge = 1 << kBlockBits;
inline constexpr int kBlockCells = kBlockEdge * kBlockEdge * kBlockEdge;

/// Index of a block: the cells' keys divided by kBlockEdge, rounded down.
struct BlockKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  friend auto operator<=>(const BlockKey&, const BlockKey&) = default;
};

[[nodiscard]] inline BlockKey blockOf(const CellKey& key) {
  return {key.x >> kBlockBits, key.y >> kBlockBits, key.z >> kBlockBits};
}
/// Place of a cell within its block, x fastest: 0 .. kBlockCells - 1.
[[nodiscard]] inline int indexInBlock(const CellKey& key) {
  constexpr int mask = kBlockEdge - 1;
  return (key.x & mask) | ((key.y & mask) << kBlockBits) | ((key.z & mask) << (2 * kBlockBits));
}
[[nodiscard]] inline CellKey cellAt(const BlockKey& block, int index) {
  constexpr int mask = kBlockEdge - 1;
  return {block.x * kBlockEdge + (index & mask), block.y * kBlockEdge + ((index >> kBlockBits) & mask),
          block.z * kBlockEdge + (index >> (2 * kBlockBits))};
}

/// Blocks are kept in tiles of 8 x 8 x 8, and tiles are what a station stores.
inline constexpr int kTileBits = 3;
inline constexpr int kTileEdge = 1 << kTileBits;
inline constexpr int kTileBlocks = kTileEdge * kTileEdge * kTileEdge;

/// Index of a tile: the blocks' keys divided by kTileEdge, rounded down.
struct TileKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  friend auto operator<=>(const TileKey&, const TileKey&) = default;
};
[[nodiscard]] inline TileKey tileOf(const BlockKey& key) {
  return {key.x >> kTileBits, key.y >> kTileBits, key.z >> kTileBits};
}
/// Place of a block within its tile, x fastest: 0 .. kTileBlocks - 1.
[[nodiscard]] inline int indexInTile(const BlockKey& key) {
  constexpr int mask = kTileEdge - 1;
  return (key.x & mask) | ((key.y & mask) << kTileBits) | ((key.z & mask) << (2 * kTileBits));
}
[[nodiscard]] inline BlockKey blockAt(const TileKey& tile, int index) {
  constexpr int mask = kTileEdge - 1;
  return {tile.x * kTileEdge + (index & mask), tile.y * kTileEdge + ((index >> kTileBits) & mask),
          tile.z * kTileEdge + (index >> (2 * kTileBits))};
}

/// A cell by its tile and its place therein.
struct CellPlace {
  TileKey tile;
  std::uint32_t in_tile = 0;  ///< block() * kBlockCells + inBlock()

  [[nodiscard]] int block() const { return static_cast<int>(in_tile / kBlockCells); }    ///< indexInTile
  [[nodiscard]] int inBlock() const { return static_cast<int>(in_tile % kBlockCells); }  ///< indexInBlock
  [[nodiscard]] CellKey key() const { return cellAt(blockAt(tile, block()), inBlock()); }
};
[[nodiscard]] inline CellPlace placeOf(const CellKey& key) {
  const BlockKey block = blockOf(key);
  return {tileOf(block), static_cast<std::uint32_t>(indexInTile(block) * kBlockCells + indexInBlock(key))};
}

struct BlockKeyHash {
  [[nodiscard]] std::size_t operator()(const BlockKey& key) const {
    // Three odd constants (as in Teschner et al. 2003), then a finaliser: neighbours must not cluster.
    std::uint64_t h = static_cast<std::uint32_t>(key.x) * 73856093ULL ^
                      static_cast<std::uint32_t>(key.y) * 19349669ULL * 0x9E3779B1ULL ^
                      static_cast<std::uint32_t>(key.z) * 83492791ULL * 0x85EBCA77ULL;
    h ^= h >> 33;
    h *= 0xff51afd7ed558ccdULL;
    h ^= h >> 33;
    return static_cast<std::size_t>(h);
  }
};

struct TileKeyHash {
  [[nodiscard]] std::size_t operator()(const TileKey& key) const {
    return BlockKeyHash{}({key.x, key.y, key.z});
  }
};

}  // namespace thermovox
