#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mapping/cell_key.hpp"
#include "mapping/hotspot.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// What of an asset is too hot, whatever the criteria of the search.
struct AssetLimits {
  std::optional<double> above;  ///< Celsius
  std::optional<double> delta;  ///< Celsius over the surroundings, and over its twins
};

/// A part of the plant: a box, and what is known of what is in it.
struct Asset {
  std::string name;
  Pose T_world_box;                                ///< the box has its middle in its own origin
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< edges of the box along its axes, metres
  std::optional<double> emissivity;                ///< of its surface, 0.05 to 1
  AssetLimits limits;
  std::string twin_group;  ///< like parts under like load (phases A, B, C); empty: it has no twins

  /// Metres from a place to the box, 0 within it and on its border.
  [[nodiscard]] double distanceTo(const Eigen::Vector3d& p_world) const;
  /// Within the box or on its border, to the nanometre.
  [[nodiscard]] bool holds(const Eigen::Vector3d& p_world) const { return distanceTo(p_world) <= 1e-9; }
};

/// The assets of a plant, by their places. Boxes may overlap and lie in one another: a place belongs to the
/// smallest that holds it, of equal ones to the first.
class Assets {
 public:
  Assets() = default;
  /// Throws ConfigError naming the asset ("assets[3].size: ...") when one has no name or that of another, a
  /// box without volume or that is not finite, an emissivity outside 0.05 to 1, a limit that is none, or a
  /// group of twins for itself.
  explicit Assets(std::vector<Asset> assets);

  [[nodiscard]] std::span<const Asset> all() const { return assets_; }
  [[nodiscard]] std::size_t size() const { return assets_.size(); }
  [[nodiscard]] const Asset& operator[](std::size_t i) const { return assets_[i]; }

  /// Index of the asset that a place (metres) belongs to.
  [[nodiscard]] std::optional<std::size_t> at(const Eigen::Vector3d& p_world) const;
  /// The asset that holds a hot spot's peak; where none does, the one with most of its cells, of equal ones
  /// the first. `resolution` is the edge of the cells, metres.
  [[nodiscard]] std::optional<std::size_t> of(const Hotspot& spot, double resolution) const;
  /// The others of its twin group, ascending.
  [[nodiscard]] std::vector<std::size_t> twinsOf(std::size_t asset) const;

 private:
  friend class CellAssets;
  std::vector<Asset> assets_;
  std::vector<std::size_t> smallest_first_;
};

/// The assets of a map's cells, by the cells' centres; quick as long as the cells come tile by tile.
class CellAssets {
 public:
  /// `resolution`: edge of the cells, metres. The assets must outlive it.
  CellAssets(const Assets& assets, double resolution) : assets_(assets), resolution_(resolution) {}
  [[nodiscard]] std::optional<std::size_t> at(const CellKey& key);

 private:
  void look(const TileKey& tile);

  const Assets& assets_;
  double resolution_;
  std::optional<TileKey> tile_;
  std::vector<std::size_t> near_;  ///< those that reach into the tile, the smallest first
};

}  // namespace thermovox
