#include "mapping/tile_table.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace thermovox {
namespace {

/// Trimming goes a quarter below the limit, so that it is not needed after every reading.
constexpr double kTrimmed = 0.75;

std::unique_ptr<MapTile> tileOf(TileBlocks blocks) {
  auto tile = std::make_unique<MapTile>();
  for (auto& [key, block] : blocks) tile->blockOrNew(indexInTile(key)) = std::move(block);
  return tile;
}

}  // namespace

void TileTable::spillTo(TileStore& store, std::size_t limit_bytes) {
  store_ = &store;
  limit_bytes_ = limit_bytes;
  std::vector<TileKey> all;
  for (const auto& [key, entry] : tiles_) all.push_back(key);
  recount(all);
}

MapTile* TileTable::find(const TileKey& key) const {
  const auto found = tiles_.find(key);
  Entry* entry = found != tiles_.end() ? &found->second : recall(key);
  if (entry == nullptr) return nullptr;
  if (store_ != nullptr) entry->used = ++clock_;
  return entry->tile.get();
}

MapTile& TileTable::findOrNew(const TileKey& key) {
  if (MapTile* found = find(key)) return *found;
  Entry& entry = tiles_[key];
  entry = {std::make_unique<MapTile>(), sizeof(MapTile), ++clock_};
  bytes_ += entry.bytes;
  return *entry.tile;
}

std::shared_ptr<const MapTile> TileTable::look(const TileKey& key) const {
  if (const auto found = tiles_.find(key); found != tiles_.end())
    return {std::shared_ptr<const MapTile>(), found->second.tile.get()};  // which the table owns
  if (store_ == nullptr || !store_->holds(key)) return nullptr;
  return read(key);
}

TileTable::Entry* TileTable::recall(const TileKey& key) const {
  if (store_ == nullptr || !store_->holds(key)) return nullptr;
  Entry entry{tileOf(store_->take(key).value()), 0, 0};
  entry.bytes = entry.tile->memoryBytes();
  bytes_ += entry.bytes;
  return &(tiles_[key] = std::move(entry));
}

std::unique_ptr<MapTile> TileTable::read(const TileKey& key) const {
  return tileOf(store_->get(key).value());
}

void TileTable::recount(std::span<const TileKey> grown) {
  if (store_ == nullptr) return;
  for (const TileKey& key : grown) {
    Entry& entry = tiles_.at(key);
    const std::size_t bytes = entry.tile->memoryBytes();
    bytes_ += bytes - entry.bytes;
    entry.bytes = bytes;
  }
}

void TileTable::grew(const TileKey& key, std::size_t bytes) {
  if (store_ == nullptr) return;
  tiles_.at(key).bytes += bytes;
  bytes_ += bytes;
}

void TileTable::trim(std::size_t reserved) {
  const std::size_t limit = limit_bytes_ - std::min(reserved, limit_bytes_);
  if (store_ == nullptr || bytes_ <= limit) return;
  std::vector<std::pair<std::uint64_t, TileKey>> by_use;
  for (const auto& [key, entry] : tiles_) by_use.emplace_back(entry.used, key);
  std::sort(by_use.begin(), by_use.end());
  by_use.pop_back();  // the tile in use stays even where it exceeds the limit, or it would come back at once
  const auto most = static_cast<std::size_t>(kTrimmed * static_cast<double>(limit));
  for (const auto& [used, key] : by_use) {
    if (bytes_ <= most) break;
    spill(key);
  }
}

void TileTable::spill(const TileKey& key) {
  const auto found = tiles_.find(key);
  store_->put(key, viewsOf(key, *found->second.tile));
  bytes_ -= found->second.bytes;
  tiles_.erase(found);
  ++spills_;
}

std::size_t TileTable::memoryBytes() const {
  std::size_t bytes = 0;
  for (const auto& [key, entry] : tiles_) bytes += entry.tile->memoryBytes();
  return bytes;
}

std::vector<TileKey> TileTable::sortedKeys() const {
  std::vector<TileKey> keys = store_ != nullptr ? store_->sortedTiles() : std::vector<TileKey>();
  for (const auto& [key, entry] : tiles_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace thermovox
