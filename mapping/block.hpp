#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mapping/cell_key.hpp"
#include "mapping/occupancy_model.hpp"
#include "mapping/surface_cell.hpp"

namespace thermovox {

/// One bit for each cell of a block: 8 words of 64, one word a layer of 8 x 8, one cache line.
using CellBits = std::array<std::uint64_t, kBlockCells / 64>;

/// The log-odds of a block's cells in quanta of the map's OccupancyModel. One mission's fit a byte a cell;
/// the sums over missions get two where a byte is too small for them.
class BlockLogOdds {
 public:
  /// What unknown cells hold in the bytes.
  static constexpr std::int8_t kUnknownByte = -128;
  using Bytes = std::array<std::int8_t, kBlockCells>;

  BlockLogOdds() { bytes_.fill(kUnknownByte); }
  BlockLogOdds(const BlockLogOdds& other);
  BlockLogOdds(BlockLogOdds&&) noexcept = default;
  BlockLogOdds& operator=(const BlockLogOdds& other);
  BlockLogOdds& operator=(BlockLogOdds&&) noexcept = default;
  ~BlockLogOdds() = default;

  [[nodiscard]] LogOdds operator[](int index) const {
    const auto i = static_cast<std::size_t>(index);
    if (wide_) return (*wide_)[i];
    return bytes_[i] == kUnknownByte ? kUnknown : LogOdds{bytes_[i]};
  }
  void set(int index, LogOdds log_odds);
  void fill(LogOdds log_odds);
  /// Adds another mission's; what is unknown adds nothing.
  void add(const BlockLogOdds& other);

  /// Whether all values are bytes, as they are in the map of one mission.
  [[nodiscard]] bool isNarrow() const { return wide_ == nullptr; }
  /// Precondition: isNarrow().
  [[nodiscard]] Bytes& bytes() { return bytes_; }
  [[nodiscard]] const Bytes& bytes() const { return bytes_; }

  [[nodiscard]] std::size_t knownCells() const;
  [[nodiscard]] std::size_t heapBytes() const { return wide_ ? sizeof(*wide_) : 0; }
  friend bool operator==(const BlockLogOdds& a, const BlockLogOdds& b);

 private:
  using Wide = std::array<LogOdds, kBlockCells>;
  void widen();

  Bytes bytes_;
  std::unique_ptr<Wide> wide_;  ///< all values once one does not fit a byte; bytes_ then says nothing
};

/// 8 x 8 x 8 cells: log-odds for all, statistics only for those that held a surface.
class Block {
 public:
  BlockLogOdds log_odds;

  [[nodiscard]] bool hasSurface(int index) const { return (mask_[index >> 6] >> (index & 63) & 1) != 0; }
  /// Statistics of a cell (indexInBlock); null where there are none. Valid until a surface is added.
  [[nodiscard]] const SurfaceCell* surface(int index) const {
    return hasSurface(index) ? &surfaces_[rank(index)] : nullptr;
  }
  [[nodiscard]] SurfaceCell* surface(int index) {
    return hasSurface(index) ? &surfaces_[rank(index)] : nullptr;
  }
  SurfaceCell& surfaceOrNew(int index) {
    return hasSurface(index) ? surfaces_[rank(index)] : addSurface(index);
  }
  [[nodiscard]] std::size_t surfaceCount() const { return surfaces_.size(); }
  /// The cells with statistics.
  [[nodiscard]] const CellBits& surfaceMask() const { return mask_; }
  /// Their statistics in ascending order of the cells.
  [[nodiscard]] std::span<const SurfaceCell> surfaces() const { return surfaces_; }
  /// Replaces all statistics. Precondition: as many as the mask has bits.
  void setSurfaces(const CellBits& mask, std::vector<SurfaceCell> surfaces);

  /// Calls visit(index, surface_cell) in ascending order of the cells.
  template <typename Visitor>
  void forEachSurface(Visitor&& visit) const {
    std::size_t next = 0;
    for (std::size_t word = 0; word < mask_.size(); ++word) {
      for (std::uint64_t bits = mask_[word]; bits != 0; bits &= bits - 1) {
        visit(static_cast<int>(64 * word) + std::countr_zero(bits), surfaces_[next++]);
      }
    }
  }

  /// Adds the block of another mission.
  void merge(const Block& other);
  /// Memory in use, the surfaces' spare room included.
  [[nodiscard]] std::size_t memoryBytes() const;
  friend bool operator==(const Block& a, const Block& b) = default;

 private:
  /// How many cells with statistics come before this one.
  [[nodiscard]] std::size_t rank(int index) const {
    const int word = index >> 6;
    int before = std::popcount(mask_[word] & ((std::uint64_t{1} << (index & 63)) - 1));
    for (int i = 0; i < word; ++i) before += std::popcount(mask_[i]);
    return static_cast<std::size_t>(before);
  }
  SurfaceCell& addSurface(int index);

  CellBits mask_{};
  std::vector<SurfaceCell> surfaces_;
};

}  // namespace thermovox
