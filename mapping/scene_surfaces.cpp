#include "mapping/scene_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mapping/local_plane.hpp"
#include "mapping/view_cone.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr int kTileCells = kTileEdge * kBlockEdge;  // an edge
constexpr std::uint64_t kViewsKept = 16;            // views after which an unused tile is forgotten
constexpr int kReach = 2;                           // cells around one that tell its normal
constexpr std::size_t kFewest = 6;                  // points that make a plane

/// The surfaces in and around a tile by their cells, to find neighbours at once.
class Neighbourhood {
 public:
  explicit Neighbourhood(const TileKey& tile)
      : origin_{tile.x * kTileCells - kReach, tile.y * kTileCells - kReach, tile.z * kTileCells - kReach},
        places_(static_cast<std::size_t>(kEdge) * kEdge * kEdge, kNone) {}

  void add(const SceneSurface& surface) {
    const int index = indexOf(surface.key, 0, 0, 0);
    if (index < 0) return;
    places_[static_cast<std::size_t>(index)] = static_cast<std::int32_t>(points_.size());
    points_.push_back(surface.p_world);
  }

  /// The plane through the surfaces within `reach` cells; none where they are too few or no plane.
  [[nodiscard]] LocalPlane planeAt(const SceneSurface& surface) const {
    for (int reach = 1; reach <= kReach; ++reach) {
      PointSums sums;
      forEachAround(surface.key, reach,
                    [&](const Eigen::Vector3d& p_world) { sums.add(p_world - surface.p_world); });
      if (sums.count >= kFewest) return localPlane(sums);
    }
    return {};
  }

 private:
  static constexpr int kEdge = kTileCells + 2 * kReach;
  static constexpr std::int32_t kNone = -1;

  [[nodiscard]] int indexOf(const CellKey& key, int dx, int dy, int dz) const {
    const int x = key.x + dx - origin_.x;
    const int y = key.y + dy - origin_.y;
    const int z = key.z + dz - origin_.z;
    if (x < 0 || y < 0 || z < 0 || x >= kEdge || y >= kEdge || z >= kEdge) return kNone;
    return (z * kEdge + y) * kEdge + x;
  }

  template <typename Visitor>
  void forEachAround(const CellKey& key, int reach, Visitor&& visit) const {
    for (int dz = -reach; dz <= reach; ++dz) {
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          const int index = indexOf(key, dx, dy, dz);
          const std::int32_t place = index < 0 ? kNone : places_[static_cast<std::size_t>(index)];
          if (place != kNone) visit(points_[static_cast<std::size_t>(place)]);
        }
      }
    }
  }

  CellKey origin_;
  std::vector<std::int32_t> places_;  ///< in points_, of every cell
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

SceneSurfaces::SceneSurfaces(std::vector<const ThermalMap*> maps) : maps_(std::move(maps)) {
  if (maps_.empty()) throw ConfigError("a scene: expected at least one map");
  for (const ThermalMap* map : maps_) {
    if (map->options() != maps_.front()->options()) {
      throw ConfigError("the maps of a scene: expected one resolution and one occupancy model");
    }
    const std::vector<TileKey> keys = map->sortedTileKeys();
    keys_.insert(keys_.end(), keys.begin(), keys.end());
  }
  std::sort(keys_.begin(), keys_.end());
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
}

std::vector<TileKey> SceneSurfaces::tilesInView(const Camera& camera, const Pose& T_camera_world,
                                                double range) const {
  const double edge = resolution() * kTileCells;
  const double radius = 0.5 * std::sqrt(3.0) * edge;
  const ViewCone cone(camera, T_camera_world, range);
  std::vector<TileKey> seen;
  for (const TileKey& key : keys_) {
    const Eigen::Vector3d center = (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5) * edge;
    if (cone.mayHold(center, radius)) seen.push_back(key);
  }
  return seen;
}

std::span<const SceneSurface> SceneSurfaces::surfacesOf(const TileKey& key) {
  const auto [place, is_new] = tiles_.try_emplace(key);
  if (is_new) place->second.surfaces = gather(key);
  place->second.view = view_;
  return place->second.surfaces;
}

const SceneSurface* SceneSurfaces::surfaceAt(const Eigen::Vector3d& p_world) {
  const CellPlace place = placeOf(cellKey(p_world, 1.0 / resolution()));
  if (!std::binary_search(keys_.begin(), keys_.end(), place.tile)) return nullptr;
  const std::span<const SceneSurface> surfaces = surfacesOf(place.tile);
  const auto found = std::lower_bound(surfaces.begin(), surfaces.end(), place.in_tile,
                                      [](const SceneSurface& surface, std::uint32_t in_tile) {
                                        return placeOf(surface.key).in_tile < in_tile;
                                      });
  return found != surfaces.end() && found->key == place.key() ? &*found : nullptr;
}

void SceneSurfaces::forgetUnused() {
  std::erase_if(tiles_, [this](const auto& tile) { return tile.second.view + kViewsKept < view_; });
  ++view_;
}

/// The tiles of all maps in and around one, looked up once; those that a map keeps elsewhere stay there.
class SceneSurfaces::Layers {
 public:
  Layers(const std::vector<const ThermalMap*>& maps, const TileKey& center) : center_(center) {
    for (int index = 0; index < kTiles; ++index) {
      const TileKey key{center.x + index % 3 - 1, center.y + index / 3 % 3 - 1, center.z + index / 9 - 1};
      for (const ThermalMap* map : maps) {
        if (auto tile = map->tile(key)) tiles_[static_cast<std::size_t>(index)].push_back(std::move(tile));
      }
    }
  }

  /// What the maps know of a block in or beside the tile.
  [[nodiscard]] std::vector<const Block*> blocksAt(const BlockKey& key) const {
    const TileKey tile = tileOf(key);
    const int index = tile.x - center_.x + 1 + 3 * (tile.y - center_.y + 1) + 9 * (tile.z - center_.z + 1);
    std::vector<const Block*> blocks;
    for (const auto& layer : tiles_[static_cast<std::size_t>(index)]) {
      if (const Block* block = layer->block(indexInTile(key))) blocks.push_back(block);
    }
    return blocks;
  }

 private:
  static constexpr int kTiles = 27;
  TileKey center_;
  std::array<std::vector<std::shared_ptr<const MapTile>>, kTiles> tiles_;
};

std::vector<SceneSurface> SceneSurfaces::gather(const TileKey& key) const {
  const Layers layers(maps_, key);
  std::vector<SceneSurface> surfaces;
  Neighbourhood neighbourhood(key);
  std::vector<SceneSurface> around;
  const BlockKey first{key.x * kTileEdge, key.y * kTileEdge, key.z * kTileEdge};
  for (int dz = -1; dz <= kTileEdge; ++dz) {
    for (int dy = -1; dy <= kTileEdge; ++dy) {
      for (int dx = -1; dx <= kTileEdge; ++dx) {
        const BlockKey block{first.x + dx, first.y + dy, first.z + dz};
        appendBlock(block, layers.blocksAt(block), tileOf(block) == key ? surfaces : around);
      }
    }
  }
  for (const SceneSurface& surface : surfaces) neighbourhood.add(surface);
  for (const SceneSurface& surface : around) neighbourhood.add(surface);
  for (SceneSurface& surface : surfaces) {
    const LocalPlane plane = neighbourhood.planeAt(surface);
    surface.normal = plane.normal;
    surface.width = static_cast<float>(std::sqrt(plane.width2));
  }
  return surfaces;
}

void SceneSurfaces::appendBlock(const BlockKey& key, std::span<const Block* const> layers,
                                std::vector<SceneSurface>& surfaces) const {
  if (layers.empty()) return;
  const OccupancyModel& model = maps_.front()->occupancyModel();
  for (int index = 0; index < kBlockCells; ++index) {
    const auto hasSurface = [index](const Block* block) { return block->hasSurface(index); };
    if (std::none_of(layers.begin(), layers.end(), hasSurface)) continue;
    SurfaceCell together;
    LogOdds log_odds = kUnknown;
    for (const Block* block : layers) {
      if (block->hasSurface(index)) together.merge(*block->surface(index));
      log_odds = addedLogOdds(log_odds, block->log_odds[index]);
    }
    if (together.returns == 0 || !model.isOccupied(log_odds)) continue;
    const CellKey cell = cellAt(key, index);
    const Eigen::Vector3d place = Eigen::Vector3d(cell.x, cell.y, cell.z) + together.meanOffset();
    surfaces.push_back({place * resolution(), Eigen::Vector3f::Zero(), cell});
  }
}

}  // namespace thermovox
