#include "io/station_tiles.hpp"

#include "io/parallel_for.hpp"
#include "io/station_schema.hpp"
#include "io/tile_codec.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// Tiles that are decoded at a time: enough to keep some processors busy, few enough to need little memory.
constexpr std::size_t kBatch = 64;

/// The key in the row's first three columns. A map reaches no further than kMaxCellKey.
TileKey tileKeyOf(const SqlStatement& row, const std::filesystem::path& path) {
  const auto index = [&](int column) {
    constexpr std::int64_t reach = kMaxCellKey >> (kBlockBits + kTileBits);
    const std::int64_t place = row.integer(column);
    if (place >= -reach && place <= reach) return static_cast<std::int32_t>(place);
    throw DataError(path.string() + ": is damaged, it has a tile at " + std::to_string(place) +
                    ", expected one within " + std::to_string(reach) + " of the origin");
  };
  return {index(0), index(1), index(2)};
}

/// The surfaces of a tile that have a temperature; null where there are none.
std::shared_ptr<const MapTile> temperaturesOf(const MapTile& tile) {
  std::shared_ptr<MapTile> layer;
  tile.forEachBlock([&](int block_index, const Block& block) {
    block.forEachSurface([&](int index, const SurfaceCell& cell) {
      if (cell.observations == 0) return;
      if (!layer) layer = std::make_shared<MapTile>();
      layer->blockOrNew(block_index).surfaceOrNew(index) = cell;
    });
  });
  return layer;
}

}  // namespace

StationTiles::StationTiles(const SqlDatabase& database, std::filesystem::path path)
    : path_(std::move(path)),
      current_(stationVersion(database) == kStationSchema),
      query_(database.prepare("SELECT x, y, z, blocks, surfaces, data FROM tiles ORDER BY x, y, z")) {
  read();
}

StationTiles::StationTiles(const SqlDatabase& database, std::filesystem::path path, std::int64_t mission_id)
    : path_(std::move(path)),
      current_(stationVersion(database) == kStationSchema),
      query_(database.prepare("SELECT x, y, z, blocks, surfaces, data FROM layers WHERE mission = ? "
                              "ORDER BY x, y, z")) {
  query_.bind(1, mission_id);
  read();
}

void StationTiles::read() {
  tile_.reset();
  if (!query_.step()) return;
  tile_.emplace(StoredTile{tileKeyOf(query_, path_), query_.integer(3), query_.integer(4),
                           std::string(query_.blob(5))});
}

std::optional<TileKey> StationTiles::key() const {
  return tile_ ? std::optional(tile_->key) : std::nullopt;
}

TileSource::Part StationTiles::next() {
  Part part;
  part.stored = std::move(tile_);
  part.station = path_;
  part.current = current_;
  read();
  return part;
}

MapTiles::MapTiles(const ThermalMap& map) : map_(map), keys_(map.sortedTileKeys()) {}

std::optional<TileKey> MapTiles::key() const {
  return place_ < keys_.size() ? std::optional(keys_[place_]) : std::nullopt;
}

TileSource::Part MapTiles::next() {
  return {.tile = map_.tile(keys_[place_++])};
}

LayerTiles::LayerTiles(const ThermalMap& map) : map_(map), keys_(map.sortedTileKeys()) {
  advance();
}

std::optional<TileKey> LayerTiles::key() const {
  return tile_ ? std::optional(keys_[place_ - 1]) : std::nullopt;
}

TileSource::Part LayerTiles::next() {
  Part part{.tile = std::move(tile_)};
  advance();
  return part;
}

void LayerTiles::advance() {
  tile_.reset();
  while (!tile_ && place_ < keys_.size()) tile_ = temperaturesOf(*map_.tile(keys_[place_++]));
}

std::int64_t surfacesIn(const TileBlocks& blocks) {
  std::int64_t count = 0;
  for (const auto& [key, block] : blocks) count += static_cast<std::int64_t>(block.surfaceCount());
  return count;
}

TileBlocks decodeStoredTile(const StoredTile& tile, const std::filesystem::path& path) {
  try {
    TileBlocks blocks = decodeTile(tile.key, tile.data);
    if (tile.blocks == static_cast<std::int64_t>(blocks.size()) && tile.surfaces == surfacesIn(blocks))
      return blocks;
  } catch (const DataError& error) {
    throw DataError(path.string() + ": " + error.what());
  }
  throw DataError(path.string() +
                  ": is damaged, a tile holds another number of blocks or surfaces than it says");
}

void forEachDecodedTile(StationTiles& tiles, const std::filesystem::path& path, int threads,
                        const std::function<void(TileBlocks&, const std::string&)>& visit) {
  while (tiles.key()) {
    std::vector<StoredTile> batch;
    while (tiles.key() && batch.size() < kBatch) batch.push_back(*tiles.next().stored);
    std::vector<TileBlocks> blocks(batch.size());
    std::vector<std::string> faults(batch.size());
    parallelFor(batch.size(), threads, [&](std::size_t i) {
      try {
        blocks[i] = decodeStoredTile(batch[i], path);
      } catch (const DataError& error) {
        faults[i] = error.what();
      }
    });
    for (std::size_t i = 0; i < batch.size(); ++i) visit(blocks[i], faults[i]);
  }
}

void loadTiles(StationTiles& tiles, const std::filesystem::path& path, int threads, ThermalMap& map) {
  forEachDecodedTile(tiles, path, threads, [&](TileBlocks& blocks, const std::string& fault) {
    if (!fault.empty()) throw DataError(fault);
    for (auto& [key, block] : blocks) map.setBlock(key, std::move(block));
  });
}

}  // namespace thermovox
