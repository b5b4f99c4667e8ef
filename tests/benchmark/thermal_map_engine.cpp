#include "tests/benchmark/engine.hpp"

namespace thermovox::bench {
namespace {

class ThermalMapEngine : public Engine {
 public:
  ThermalMapEngine(double resolution, Carving carving, int threads)
      : map_({.resolution = resolution}), carving_(carving) {
    map_.setThreads(threads);
  }

  void insert(std::span<const MappedReturn> scan) override { map_.integrate(scan, carving_); }

  [[nodiscard]] Cells cells() const override {
    Cells cells{.surface = static_cast<double>(map_.surfaceCount())};
    if (carving_ == Carving::none) {
      cells.known = cells.surface;
      return cells;
    }
    map_.forEachBlock([&cells](const BlockKey&, const Block& block) {
      cells.known += static_cast<double>(block.log_odds.knownCells());
    });
    return cells;
  }

 private:
  ThermalMap map_;
  Carving carving_;
};

}  // namespace

EnginePointer thermalMapEngine(double resolution, Carving carving, int threads) {
  return std::make_unique<ThermalMapEngine>(resolution, carving, threads);
}

}  // namespace thermovox::bench
