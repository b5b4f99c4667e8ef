#include "mapping/thermal_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>

#include "mapping/ray_cells.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

bool isWithin(const Eigen::Vector3d& p_world, double reach) {
  return p_world.cwiseAbs().maxCoeff() < reach && p_world.allFinite();
}

/// One step for every cell whose bit is set.
void update(BlockLogOdds& log_odds, const CellBits& cells, int step, const OccupancyModel& model) {
  for (std::size_t word = 0; word < cells.size(); ++word) {
    for (std::uint64_t bits = cells[word]; bits != 0; bits &= bits - 1) {
      const int index = static_cast<int>(64 * word) + std::countr_zero(bits);
      log_odds.set(index, model.updated(log_odds[index], step));
    }
  }
}

/// Place within its cell, in edges.
Eigen::Vector3d offsetInCell(const Eigen::Vector3d& p_world, const CellKey& key, double inverse_resolution) {
  return p_world * inverse_resolution - Eigen::Vector3d(key.x, key.y, key.z);
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

ThermalMap::ThermalMap(const Options& options) : options_(options), model_(options.occupancy) {
  options_.validate();
}

void ThermalMap::integrate(std::span<const MappedReturn> reading, Carving carving) {
  check(reading);
  updateOccupancy(reading, carving);
  updateSurfaces(reading);
}

void ThermalMap::check(std::span<const MappedReturn> reading) const {
  const double reach = kMaxCellKey * options_.resolution;
  for (const MappedReturn& ret : reading) {
    std::ostringstream message;
    if (!isWithin(ret.p_world, reach) || !isWithin(ret.origin_world, reach)) {
      message << "a return at (" << ret.p_world.transpose() << ") m seen from ("
              << ret.origin_world.transpose() << ") m came to the map, expected coordinates within " << reach
              << " m of the origin of the world: use a local one";
      throw DataError(message.str());
    }
    if (ret.temperature &&
        !(std::isfinite(ret.temperature->celsius) && std::isfinite(ret.temperature->sigma))) {
      message << "a temperature of " << ret.temperature->celsius << " C with sigma " << ret.temperature->sigma
              << " C came to the map, expected finite numbers";
      throw DataError(message.str());
    }
  }
}

void ThermalMap::updateOccupancy(std::span<const MappedReturn> reading, Carving carving) {
  for (const MappedReturn& ret : reading) {
    marks_.markHit(keyOf(ret.p_world));
    if (carving == Carving::none) continue;
    RayCells(ret.origin_world, ret.p_world, options_.resolution).forEach([this](const CellKey& key) {
      marks_.markFree(key);
    });
  }
  for (const ReadingMarks::Tile& tile : marks_.sortedTiles()) {
    Block& block = blockOrNew(tile.key);
    CellBits free = tile.free;
    for (std::size_t word = 0; word < free.size(); ++word) free[word] &= ~tile.hit[word];
    update(block.log_odds, free, model_.miss(), model_);
    update(block.log_odds, tile.hit, model_.hit(), model_);
  }
  marks_.clear();
}

void ThermalMap::updateSurfaces(std::span<const MappedReturn> reading) {
  const double inverse = 1.0 / options_.resolution;
  for (const MappedReturn& ret : reading) {
    const CellKey key = cellKey(ret.p_world, inverse);
    SurfaceCell& cell = blockOrNew(blockOf(key)).surfaceOrNew(indexInBlock(key));
    cell.addReturn(offsetInCell(ret.p_world, key, inverse));
    if (ret.temperature) cell.addTemperature(*ret.temperature, ret.stamp);
  }
}

void ThermalMap::observe(const CellKey& key, const TemperatureObservation& observation, Time stamp) {
  blockOrNew(blockOf(key)).surfaceOrNew(indexInBlock(key)).addTemperature(observation, stamp);
}

void ThermalMap::merge(const ThermalMap& other) {
  if (other.options_ != options_) {
    std::ostringstream message;
    message << "maps of " << options_.resolution << " m and " << other.options_.resolution
            << " m cells cannot be merged, expected one resolution and one occupancy model";
    throw ConfigError(message.str());
  }
  for (const auto& [key, block] : other.blocks_) blockOrNew(key).merge(*block);
}

Eigen::Vector3d ThermalMap::centerOf(const CellKey& key) const {
  return (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5) * options_.resolution;
}

Occupancy ThermalMap::occupancy(const CellKey& key) const {
  const Block* found = block(blockOf(key));
  const LogOdds log_odds = found ? found->log_odds[indexInBlock(key)] : kUnknown;
  if (log_odds == kUnknown) return Occupancy::unknown;
  return model_.isOccupied(log_odds) ? Occupancy::occupied : Occupancy::free;
}

std::optional<double> ThermalMap::logOdds(const CellKey& key) const {
  const Block* found = block(blockOf(key));
  const LogOdds log_odds = found ? found->log_odds[indexInBlock(key)] : kUnknown;
  if (log_odds == kUnknown) return std::nullopt;
  return model_.naturalLogOdds(log_odds);
}

const SurfaceCell* ThermalMap::surface(const CellKey& key) const {
  const Block* found = block(blockOf(key));
  return found ? found->surface(indexInBlock(key)) : nullptr;
}

std::size_t ThermalMap::surfaceCount() const {
  std::size_t count = 0;
  for (const auto& [key, block] : blocks_) count += block->surfaceCount();
  return count;
}

const Block* ThermalMap::block(const BlockKey& key) const {
  const auto found = blocks_.find(key);
  return found == blocks_.end() ? nullptr : found->second.get();
}

Block& ThermalMap::blockOrNew(const BlockKey& key) {
  std::unique_ptr<Block>& found = blocks_[key];
  if (!found) found = std::make_unique<Block>();
  return *found;
}

void ThermalMap::setBlock(const BlockKey& key, Block block) {
  blockOrNew(key) = std::move(block);
}

std::vector<BlockKey> ThermalMap::sortedBlockKeys() const {
  std::vector<BlockKey> keys;
  keys.reserve(blocks_.size());
  for (const auto& [key, block] : blocks_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace thermovox
