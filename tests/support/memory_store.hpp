#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mapping/tile_store.hpp"

namespace thermovox::test {

/// A store in memory.
class MemoryStore : public TileStore {
 public:
  void put(const TileKey& tile, std::span<const BlockView> blocks) override {
    TileBlocks copy;
    for (const BlockView& view : blocks) copy.emplace(view.key, *view.block);
    tiles_[tile] = std::move(copy);
  }
  std::optional<TileBlocks> take(const TileKey& tile) override {
    auto node = tiles_.extract(tile);
    if (node.empty()) return std::nullopt;
    return std::move(node.mapped());
  }
  std::optional<TileBlocks> get(const TileKey& tile) const override {
    const auto found = tiles_.find(tile);
    return found == tiles_.end() ? std::nullopt : std::optional(found->second);
  }
  bool holds(const TileKey& tile) const override { return tiles_.contains(tile); }
  std::vector<TileKey> sortedTiles() const override {
    std::vector<TileKey> keys;
    for (const auto& [key, blocks] : tiles_) keys.push_back(key);
    return keys;
  }

 private:
  std::map<TileKey, TileBlocks> tiles_;
};

}  // namespace thermovox::test
