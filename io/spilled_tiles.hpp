#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "mapping/tile_store.hpp"

namespace thermovox {

/// Tiles in a file without a name, compressed and checksummed: it is gone with the object, and with the
/// process however that ends. The room of tiles that were taken or replaced is used again. DataErrors name
/// the folder.
class SpilledTiles final : public TileStore {
 public:
  /// The file lies in this folder, as a rule the station's: where the station fits, the tiles do. Nothing is
  /// written before the first put().
  explicit SpilledTiles(std::filesystem::path folder);
  ~SpilledTiles() override;
  SpilledTiles(const SpilledTiles&) = delete;
  SpilledTiles& operator=(const SpilledTiles&) = delete;

  void put(const TileKey& tile, std::span<const BlockView> blocks) override;
  [[nodiscard]] std::optional<TileBlocks> take(const TileKey& tile) override;
  [[nodiscard]] std::optional<TileBlocks> get(const TileKey& tile) const override;
  [[nodiscard]] bool holds(const TileKey& tile) const override { return places_.contains(tile); }
  [[nodiscard]] std::vector<TileKey> sortedTiles() const override;

  /// Of the file, bytes.
  [[nodiscard]] std::uint64_t fileSize() const { return end_; }

 private:
  struct Place {
    std::uint64_t offset = 0;
    std::uint64_t room = 0;  ///< bytes that are set aside for it
    std::uint64_t size = 0;  ///< bytes of it that the tile fills
  };
  void open();
  [[nodiscard]] Place placeFor(std::uint64_t size);
  void forget(const TileKey& tile);
  [[noreturn]] void fail(const char* action, int error) const;

  std::filesystem::path folder_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;
  std::map<TileKey, Place> places_;
  std::map<std::uint64_t, std::vector<std::uint64_t>> free_;  ///< offsets of unused room, by its size
};

}  // namespace thermovox
