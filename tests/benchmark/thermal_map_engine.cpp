#include "tests/benchmark/engine.hpp"

namespace thermovox::bench {
namespace {

class ThermalMapEngine : public Engine {
 public:
  ThermalMapEngine(double resolution, Carving carving)
      : map_({.resolution = resolution}), carving_(carving) {}

  void insert(std::span<const MappedReturn> scan) override { map_.integrate(scan, carving_); }

  [[nodiscard]] Cells cells() const override {
    Cells cells{.surface = static_cast<double>(map_.surfaceCount())};
    if (carving_ == Carving::none) {
      cells.known = cells.surface;
      return cells;
    }
    for (const BlockKey& key : map_.sortedBlockKeys()) {
      for (int i = 0; i < kBlockCells; ++i)
        cells.known += map_.occupancy(cellAt(key, i)) == Occupancy::unknown ? 0.0 : 1.0;
    }
    return cells;
  }

 private:
  ThermalMap map_;
  Carving carving_;
};

}  // namespace

EnginePointer thermalMapEngine(double resolution, Carving carving) {
  return std::make_unique<ThermalMapEngine>(resolution, carving);
}

}  // namespace thermovox::bench
