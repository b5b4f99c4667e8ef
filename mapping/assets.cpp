#include "mapping/assets.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "projection/error.hpp"

namespace thermovox {
namespace {

void checkBox(const Asset& asset, const std::string& place) {
  if (!(asset.size.allFinite() && asset.size.minCoeff() > 0.0)) {
    throw ConfigError(place + ".size: has an edge of " + std::to_string(asset.size.minCoeff()) +
                      " m, expected edges of more than 0 m");
  }
  if (!asset.T_world_box.translation.allFinite() || !asset.T_world_box.rotation.coeffs().allFinite()) {
    throw ConfigError(place + ": its place is not finite, expected metres");
  }
}

void checkSurface(const Asset& asset, const std::string& place) {
  if (asset.emissivity && !(*asset.emissivity >= 0.05 && *asset.emissivity <= 1.0)) {
    throw ConfigError(place + ".emissivity: is " + std::to_string(*asset.emissivity) +
                      ", expected a number from 0.05 to 1");
  }
  if (asset.limits.above && !std::isfinite(*asset.limits.above)) {
    throw ConfigError(place + ".limits.above: expected a temperature in Celsius");
  }
  if (asset.limits.delta && !(*asset.limits.delta > 0.0 && std::isfinite(*asset.limits.delta))) {
    throw ConfigError(place + ".limits.delta: is " + std::to_string(*asset.limits.delta) +
                      " C, expected more than 0 C");
  }
}

Eigen::Vector3d centreOf(const CellKey& key, double resolution) {
  return (Eigen::Vector3d(key.x, key.y, key.z) + Eigen::Vector3d::Constant(0.5)) * resolution;
}

}  // namespace

double Asset::distanceTo(const Eigen::Vector3d& p_world) const {
  const Eigen::Vector3d p_box = T_world_box.inverse() * p_world;
  return (p_box.cwiseAbs() - size / 2.0).cwiseMax(0.0).norm();
}

Assets::Assets(std::vector<Asset> assets) : assets_(std::move(assets)), smallest_first_(assets_.size()) {
  std::set<std::string> names;
  std::map<std::string, std::size_t> groups;
  for (std::size_t i = 0; i < assets_.size(); ++i) {
    const Asset& asset = assets_[i];
    const std::string place = "assets[" + std::to_string(i) + "]";
    if (asset.name.empty()) throw ConfigError(place + ".name: is empty, expected a name");
    if (!names.insert(asset.name).second) {
      throw ConfigError(place + ".name: '" + asset.name + "' is the name of an asset before it too");
    }
    checkBox(asset, place);
    checkSurface(asset, place);
    ++groups[asset.twin_group];
  }
  for (std::size_t i = 0; i < assets_.size(); ++i) {
    const std::string& group = assets_[i].twin_group;
    if (!group.empty() && groups[group] < 2) {
      throw ConfigError("assets[" + std::to_string(i) + "].twin_group: no other asset is of '" + group +
                        "', expected one at least");
    }
  }
  std::iota(smallest_first_.begin(), smallest_first_.end(), std::size_t{0});
  std::stable_sort(smallest_first_.begin(), smallest_first_.end(), [this](std::size_t a, std::size_t b) {
    return assets_[a].size.prod() < assets_[b].size.prod();
  });
}

std::optional<std::size_t> Assets::at(const Eigen::Vector3d& p_world) const {
  const auto found = std::find_if(smallest_first_.begin(), smallest_first_.end(),
                                  [&](std::size_t i) { return assets_[i].holds(p_world); });
  return found == smallest_first_.end() ? std::nullopt : std::optional(*found);
}

std::optional<std::size_t> Assets::of(const Hotspot& spot, double resolution) const {
  if (const std::optional<std::size_t> holds_peak = at(spot.position.p_world)) return holds_peak;
  std::map<std::size_t, std::size_t> cells;
  for (const CellKey& key : spot.cells) {
    if (const std::optional<std::size_t> asset = at(centreOf(key, resolution))) ++cells[*asset];
  }
  const auto most = std::max_element(cells.begin(), cells.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == cells.end() ? std::nullopt : std::optional(most->first);
}

std::vector<std::size_t> Assets::twinsOf(std::size_t asset) const {
  std::vector<std::size_t> twins;
  if (assets_[asset].twin_group.empty()) return twins;
  for (std::size_t i = 0; i < assets_.size(); ++i) {
    if (i != asset && assets_[i].twin_group == assets_[asset].twin_group) twins.push_back(i);
  }
  return twins;
}

std::optional<std::size_t> CellAssets::at(const CellKey& key) {
  const TileKey tile = tileOf(blockOf(key));
  if (tile_ != tile) look(tile);
  const Eigen::Vector3d centre = centreOf(key, resolution_);
  for (const std::size_t i : near_) {
    if (assets_[i].holds(centre)) return i;
  }
  return std::nullopt;
}

void CellAssets::look(const TileKey& tile) {
  const double edge = kTileEdge * kBlockEdge * resolution_;
  const Eigen::Vector3d middle =
      (Eigen::Vector3d(tile.x, tile.y, tile.z) + Eigen::Vector3d::Constant(0.5)) * edge;
  tile_ = tile;
  near_.clear();
  for (const std::size_t i : assets_.smallest_first_) {
    if (assets_[i].distanceTo(middle) <= edge) near_.push_back(i);  // the corners are 0.87 edges away
  }
}

}  // namespace thermovox
