#include <unordered_map>

#include "tests/benchmark/engine.hpp"

namespace thermovox::bench {
namespace {

class BlockFloor : public Engine {
 public:
  explicit BlockFloor(double resolution) : inverse_resolution_(1.0 / resolution) {}

  void insert(std::span<const MappedReturn> scan) override {
    for (const MappedReturn& ret : scan) {
      const CellKey key = cellKey(ret.p_world, inverse_resolution_);
      if (const BlockKey block = blockOf(key); last_ == nullptr || block != last_key_) {
        std::unique_ptr<Block>& found = blocks_[block];
        if (!found) found = std::make_unique<Block>();
        last_key_ = block;
        last_ = found.get();
      }
      Sums& sums = (*last_)[static_cast<std::size_t>(indexInBlock(key))];
      const float celsius = ret.temperature->celsius;
      sums.celsius += celsius;
      sums.square += celsius * celsius;
      ++sums.count;
    }
  }

  [[nodiscard]] Cells cells() const override {
    Cells cells;
    for (const auto& [key, block] : blocks_) {
      for (const Sums& sums : *block) cells.surface += sums.count > 0 ? 1.0 : 0.0;
    }
    cells.known = cells.surface;
    return cells;
  }

 private:
  struct Sums {
    float celsius = 0.0F, square = 0.0F;
    std::uint32_t count = 0;
  };
  using Block = std::array<Sums, kBlockCells>;

  double inverse_resolution_;
  std::unordered_map<BlockKey, std::unique_ptr<Block>, BlockKeyHash> blocks_;
  BlockKey last_key_;
  Block* last_ = nullptr;
};

}  // namespace

EnginePointer blockFloor(double resolution) {
  return std::make_unique<BlockFloor>(resolution);
}

}  // namespace thermovox::bench
