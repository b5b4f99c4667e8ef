#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "mapping/map_tile.hpp"
#include "mapping/tile_store.hpp"

namespace thermovox {

/// The tiles of a map by their keys. With a store and a limit, those not used for longest leave memory for
/// the store and come back when they are asked for. Not thread-safe, not even for reading, once tiles may be
/// in the store.
class TileTable {
 public:
  /// Keeps the memory of the tiles near or below `limit_bytes` from the next trim() on. The store must
  /// outlive the table.
  void spillTo(TileStore& store, std::size_t limit_bytes);

  /// Valid until trim().
  [[nodiscard]] MapTile* find(const TileKey& key) const;
  [[nodiscard]] MapTile& findOrNew(const TileKey& key);
  /// To look at for a while: what is in the store is read and stays there. Null where nothing is known; valid
  /// until the table changes.
  [[nodiscard]] std::shared_ptr<const MapTile> look(const TileKey& key) const;

  /// To be called when tiles have grown, where there is a limit: counts their memory anew.
  void recount(std::span<const TileKey> grown);
  /// The same for a tile that has grown by so many bytes.
  void grew(const TileKey& key, std::size_t bytes);
  /// Puts tiles into the store until the rest fits the limit less `reserved` bytes; those used last stay, and
  /// always the very last.
  void trim(std::size_t reserved = 0);
  /// As given to spillTo(); none before.
  [[nodiscard]] std::optional<std::size_t> limitBytes() const {
    return store_ != nullptr ? std::optional(limit_bytes_) : std::nullopt;
  }
  /// Memory of the tiles that are not in the store.
  [[nodiscard]] std::size_t memoryBytes() const;
  /// Tiles that were put into the store so far.
  [[nodiscard]] std::size_t spills() const { return spills_; }

  /// All, also those in the store.
  [[nodiscard]] std::vector<TileKey> sortedKeys() const;

  /// Calls visit(key, tile) for every tile that keep(key) lets pass, in no particular order. What is in the
  /// store is read and stays there.
  template <typename Keep, typename Visitor>
  void forEach(Keep&& keep, Visitor&& visit) const {
    for (const auto& [key, entry] : tiles_) {
      if (keep(key)) visit(key, static_cast<const MapTile&>(*entry.tile));
    }
    if (store_ == nullptr) return;
    for (const TileKey& key : store_->sortedTiles()) {
      if (keep(key)) visit(key, static_cast<const MapTile&>(*read(key)));
    }
  }

  /// Calls visit(key, tile) for every tile in ascending order of the keys.
  template <typename Visitor>
  void forEachSorted(Visitor&& visit) const {
    for (const TileKey& key : sortedKeys()) {
      if (const auto found = tiles_.find(key); found != tiles_.end()) {
        visit(key, static_cast<const MapTile&>(*found->second.tile));
      } else {
        visit(key, static_cast<const MapTile&>(*read(key)));
      }
    }
  }

 private:
  struct Entry {
    std::unique_ptr<MapTile> tile;
    std::size_t bytes = 0;
    std::uint64_t used = 0;  ///< when, in look-ups
  };
  [[nodiscard]] std::unique_ptr<MapTile> read(const TileKey& key) const;
  [[nodiscard]] Entry* recall(const TileKey& key) const;
  void spill(const TileKey& key);

  mutable std::unordered_map<TileKey, Entry, TileKeyHash> tiles_;
  mutable std::size_t bytes_ = 0;
  mutable std::uint64_t clock_ = 0;
  TileStore* store_ = nullptr;
  std::size_t limit_bytes_ = 0;
  std::size_t spills_ = 0;
};

}  // namespace thermovox
