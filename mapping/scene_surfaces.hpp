#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "mapping/thermal_map.hpp"
#include "projection/camera.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// The surface in one cell of a scene.
struct SceneSurface {
  Eigen::Vector3d p_world;  ///< mean of the cell's returns, metres
  Eigen::Vector3f normal;   ///< of the plane through its neighbours, unit, sign arbitrary; zero: no plane
  CellKey key;
  float width = 0.0F;  ///< of that plane: standard deviation of the points along its shorter axis, metres
};

/// The whole geometry that a second look is taken at: the surfaces of one or several maps together, without
/// those that are free by the sum of the maps' log-odds (what stood there has moved away).
///
/// Surfaces are gathered tile by tile when a view first needs them, with normals from the neighbouring cells,
/// and forgotten when no view has needed the tile for a while: the memory in use is that of what a few views
/// see, whatever the size of the maps. Not thread-safe.
class SceneSurfaces {
 public:
  /// The maps must outlive the scene, and their geometry must stand still. Throws ConfigError when there is
  /// none or their options differ.
  explicit SceneSurfaces(std::vector<const ThermalMap*> maps);

  [[nodiscard]] double resolution() const { return maps_.front()->resolution(); }

  /// The surface in the cell that holds the point (metres, within what cell keys reach); null where there is
  /// none. Valid until the next view.
  [[nodiscard]] const SceneSurface* surfaceAt(const Eigen::Vector3d& p_world);

  /// Calls visit(surface) for the surfaces of all tiles that reach into a camera's view, nearer than `range`
  /// (metres from the camera), in the order of their tiles' keys. It visits surfaces around the view too.
  template <typename Visitor>
  void forEachInView(const Camera& camera, const Pose& T_camera_world, double range, Visitor&& visit) {
    for (const TileKey& key : tilesInView(camera, T_camera_world, range)) {
      for (const SceneSurface& surface : surfacesOf(key)) visit(surface);
    }
    forgetUnused();
  }

 private:
  struct Tile {
    std::vector<SceneSurface> surfaces;  ///< in the order of their blocks in the tile, and cells in the block
    std::uint64_t view = 0;              ///< the last one that needed it
  };
  [[nodiscard]] std::vector<TileKey> tilesInView(const Camera& camera, const Pose& T_camera_world,
                                                 double range) const;
  [[nodiscard]] std::span<const SceneSurface> surfacesOf(const TileKey& key);
  class Layers;
  [[nodiscard]] std::vector<SceneSurface> gather(const TileKey& key) const;
  void appendBlock(const BlockKey& key, std::span<const Block* const> layers,
                   std::vector<SceneSurface>& surfaces) const;
  void forgetUnused();

  std::vector<const ThermalMap*> maps_;
  std::vector<TileKey> keys_;  ///< of all tiles with a block, ascending
  std::map<TileKey, Tile> tiles_;
  std::uint64_t view_ = 0;
};

}  // namespace thermovox
