#include "mapping/tile_store.hpp"

namespace thermovox {

std::vector<BlockView> viewsOf(const TileKey& key, const MapTile& tile) {
  std::vector<BlockView> views;
  tile.forEachBlock([&](int index, const Block& block) { views.push_back({blockAt(key, index), &block}); });
  return views;
}

}  // namespace thermovox
