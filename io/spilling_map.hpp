#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "io/spilled_tiles.hpp"
#include "mapping/thermal_map.hpp"

namespace thermovox {

/// A map with the file that takes what does not fit its memory.
struct SpillingMap {
  SpilledTiles store;
  ThermalMap map;

  /// The file lies in this folder.
  SpillingMap(std::filesystem::path folder, const ThermalMap::Options& options)
      : store(std::move(folder)), map(options) {}
  void limitTo(std::uint64_t bytes) { map.spillTo(store, static_cast<std::size_t>(bytes)); }
};

}  // namespace thermovox
