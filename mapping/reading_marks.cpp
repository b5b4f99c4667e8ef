#include "mapping/reading_marks.hpp"

#include <algorithm>

namespace thermovox {

/// Where the key stands in slots_, or where it would.
std::size_t ReadingMarks::slotOf(const BlockKey& key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = BlockKeyHash{}(key)&mask;
  while (slots_[slot] != kEmpty && tiles_[slots_[slot]].key != key) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t ReadingMarks::find(const BlockKey& key) {
  if (2 * (tiles_.size() + 1) > slots_.size()) grow();
  std::uint32_t& index = slots_[slotOf(key)];
  if (index == kEmpty) {
    index = static_cast<std::uint32_t>(tiles_.size());
    tiles_.push_back({key});
  }
  return index;
}

void ReadingMarks::grow() {
  slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), kEmpty);
  for (std::uint32_t i = 0; i < tiles_.size(); ++i) slots_[slotOf(tiles_[i].key)] = i;
}

const std::vector<ReadingMarks::Tile>& ReadingMarks::sortedTiles() {
  // Backwards: taking out what went in last leaves the table as it was before, so all others are still found.
  for (auto tile = tiles_.rbegin(); tile != tiles_.rend(); ++tile) slots_[slotOf(tile->key)] = kEmpty;
  std::sort(tiles_.begin(), tiles_.end(), [](const Tile& a, const Tile& b) { return a.key < b.key; });
  return tiles_;
}

void ReadingMarks::clear() {
  tiles_.clear();
  last_ = 0;
}

}  // namespace thermovox
