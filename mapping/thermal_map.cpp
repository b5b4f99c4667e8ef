#include "mapping/thermal_map.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "projection/error.hpp"

namespace thermovox {
namespace {

bool isWithin(const Eigen::Vector3d& p_world, double reach) {
  return p_world.cwiseAbs().maxCoeff() < reach && p_world.allFinite();
}

DataError tooFarOut(const MappedReturn& ret, double reach) {
  std::ostringstream message;
  message << "a return at (" << ret.p_world.transpose() << ") m seen from (" << ret.origin_world.transpose()
          << ") m came to the map, expected coordinates within " << reach
          << " m of the origin of the world: use a local one";
  return DataError(message.str());
}

}  // namespace

void ThermalMap::Options::validate() const {
  if (!(resolution >= 1e-4 && resolution <= 1e3)) {
    std::ostringstream message;
    message << "resolution is " << resolution << " m, expected 0.0001 to 1000";
    throw ConfigError(message.str());
  }
  occupancy.validate();
}

ThermalMap::ThermalMap(const Options& options)
    : options_(options), model_(options.occupancy), integrator_(model_, options.resolution) {
  options_.validate();
}

void ThermalMap::integrate(std::span<const MappedReturn> reading, Carving carving) {
  check(reading);
  if (!reading.empty()) integrator_.integrate(reading, carving, tiles_);
  keepFewMarks();
  trim();
}

void ThermalMap::spillTo(TileStore& store, std::size_t limit_bytes) {
  tiles_.spillTo(store, limit_bytes);
  keepFewMarks();
  trim();
}

void ThermalMap::keepFewMarks() {
  if (const std::optional<std::size_t> limit = tiles_.limitBytes()) integrator_.keepAtMost(*limit / 4);
}

void ThermalMap::check(std::span<const MappedReturn> reading) const {
  const double reach = kMaxCellKey * options_.resolution;
  for (const MappedReturn& ret : reading) {
    if (!isWithin(ret.p_world, reach) || !isWithin(ret.origin_world, reach)) throw tooFarOut(ret, reach);
    if (ret.temperature) checkFinite(*ret.temperature);
  }
}

void ThermalMap::observe(const CellKey& key, const TemperatureObservation& observation, Time stamp) {
  checkFinite(observation);
  const BlockKey block_key = blockOf(key);
  MapTile& tile = tiles_.findOrNew(tileOf(block_key));
  const Block* known = tile.block(indexInTile(block_key));
  const std::size_t before = known != nullptr ? known->memoryBytes() : 0;
  Block& block = tile.blockOrNew(indexInTile(block_key));
  block.surfaceOrNew(indexInBlock(key)).addTemperature(observation, stamp);
  tiles_.grew(tileOf(block_key), block.memoryBytes() - before);
  trim();
}

void ThermalMap::mergeBlock(const BlockKey& key, const Block& block) {
  tiles_.findOrNew(tileOf(key)).blockOrNew(indexInTile(key)).merge(block);
  tiles_.recount({{tileOf(key)}});
  trim();
}

void ThermalMap::merge(const ThermalMap& other) {
  if (other.options_ != options_) {
    std::ostringstream message;
    message << "maps of " << options_.resolution << " m and " << other.options_.resolution
            << " m cells cannot be merged, expected one resolution and one occupancy model";
    throw ConfigError(message.str());
  }
  other.forEachTile([this](const TileKey& key, const MapTile& from) {
    MapTile& tile = tiles_.findOrNew(key);
    from.forEachBlock([&](int index, const Block& block) { tile.blockOrNew(index).merge(block); });
    tiles_.recount({{key}});
    trim();
  });
}

Eigen::Vector3d ThermalMap::centerOf(const CellKey& key) const {
  return (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5) * options_.resolution;
}

LogOdds ThermalMap::logOddsOf(const CellKey& key) const {
  const Block* found = block(blockOf(key));
  return found ? found->log_odds[indexInBlock(key)] : kUnknown;
}

Occupancy ThermalMap::occupancy(const CellKey& key) const {
  const LogOdds log_odds = logOddsOf(key);
  if (log_odds == kUnknown) return Occupancy::unknown;
  return model_.isOccupied(log_odds) ? Occupancy::occupied : Occupancy::free;
}

std::optional<double> ThermalMap::logOdds(const CellKey& key) const {
  const LogOdds log_odds = logOddsOf(key);
  if (log_odds == kUnknown) return std::nullopt;
  return model_.naturalLogOdds(log_odds);
}

const SurfaceCell* ThermalMap::surface(const CellKey& key) const {
  const Block* found = block(blockOf(key));
  return found ? found->surface(indexInBlock(key)) : nullptr;
}

std::size_t ThermalMap::blockCount() const {
  std::size_t count = 0;
  forEachBlock([&count](const BlockKey&, const Block&) { ++count; });
  return count;
}

std::size_t ThermalMap::surfaceCount() const {
  std::size_t count = 0;
  forEachBlock([&count](const BlockKey&, const Block& block) { count += block.surfaceCount(); });
  return count;
}

std::size_t ThermalMap::memoryBytes() const {
  return tiles_.memoryBytes() + integrator_.memoryBytes();
}

const Block* ThermalMap::block(const BlockKey& key) const {
  const MapTile* tile = tiles_.find(tileOf(key));
  return tile ? tile->block(indexInTile(key)) : nullptr;
}

void ThermalMap::setBlock(const BlockKey& key, Block block) {
  tiles_.findOrNew(tileOf(key)).blockOrNew(indexInTile(key)) = std::move(block);
  tiles_.recount({{tileOf(key)}});
  trim();
}

std::vector<BlockKey> ThermalMap::sortedBlockKeys() const {
  std::vector<BlockKey> keys;
  forEachBlock([&keys](const BlockKey& key, const Block&) { keys.push_back(key); });
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace thermovox
