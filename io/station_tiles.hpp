#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/sqlite.hpp"
#include "mapping/thermal_map.hpp"
#include "mapping/tile_store.hpp"

namespace thermovox {

/// A tile as it lies in a station.
struct StoredTile {
  TileKey key;
  std::int64_t blocks = 0;    ///< that it says it has
  std::int64_t surfaces = 0;  ///< cells that hold a surface, as it says
  std::string data;           ///< as encodeTile made it
};

/// The tiles of one map in ascending order of their keys.
class TileSource {
 public:
  virtual ~TileSource() = default;
  TileSource(const TileSource&) = delete;
  TileSource& operator=(const TileSource&) = delete;

  /// Of the tile at hand; nullopt after the last.
  [[nodiscard]] virtual std::optional<TileKey> key() const = 0;

  /// What the source has of the tile at hand: a tile of a station, or of a map that lives on.
  struct Part {
    std::optional<StoredTile> stored;
    std::filesystem::path station;  ///< in which it is stored
    bool current = false;           ///< `stored` is as this program would write it
    std::shared_ptr<const MapTile> tile;
  };
  /// Gives the tile at hand and goes to the next.
  [[nodiscard]] virtual Part next() = 0;

 protected:
  TileSource() = default;
};

/// The tiles of a station's database, which must live on; `path` stands for it in messages.
class StationTiles final : public TileSource {
 public:
  StationTiles(const SqlDatabase& database, std::filesystem::path path);
  /// The tiles of one mission's layer, by the mission's id.
  StationTiles(const SqlDatabase& database, std::filesystem::path path, std::int64_t mission_id);
  [[nodiscard]] std::optional<TileKey> key() const override;
  [[nodiscard]] Part next() override;

 private:
  void read();

  std::filesystem::path path_;
  bool current_;
  SqlStatement query_;
  std::optional<StoredTile> tile_;
};

/// The tiles of a map, which must live on and stay as it is.
class MapTiles final : public TileSource {
 public:
  explicit MapTiles(const ThermalMap& map);
  [[nodiscard]] std::optional<TileKey> key() const override;
  [[nodiscard]] Part next() override;

 private:
  const ThermalMap& map_;
  std::vector<TileKey> keys_;  ///< ascending
  std::size_t place_ = 0;
};

/// The same of a mission's map, but only the surfaces that have a temperature, and no occupancy: its layer.
class LayerTiles final : public TileSource {
 public:
  explicit LayerTiles(const ThermalMap& map);
  [[nodiscard]] std::optional<TileKey> key() const override;
  [[nodiscard]] Part next() override;

 private:
  void advance();

  const ThermalMap& map_;
  std::vector<TileKey> keys_;  ///< ascending
  std::size_t place_ = 0;
  std::shared_ptr<const MapTile> tile_;  ///< at hand; null after the last
};

/// The tile's blocks. Throws DataError naming the station, and when the tile holds other than it says.
[[nodiscard]] TileBlocks decodeStoredTile(const StoredTile& tile, const std::filesystem::path& path);

/// Decodes all tiles on so many threads (0: one for each processor) and calls visit(blocks, fault) for each
/// in the order of their keys: a tile without fault, or a fault (one sentence) and no blocks.
void forEachDecodedTile(StationTiles& tiles, const std::filesystem::path& path, int threads,
                        const std::function<void(TileBlocks&, const std::string&)>& visit);

/// Puts all tiles into a map without content, which may have a limit of its memory. Throws DataError naming
/// the first damaged one.
void loadTiles(StationTiles& tiles, const std::filesystem::path& path, int threads, ThermalMap& map);

[[nodiscard]] std::int64_t surfacesIn(const TileBlocks& blocks);

}  // namespace thermovox
