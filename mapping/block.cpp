#include "mapping/block.hpp"

#include <algorithm>
#include <cassert>

namespace thermovox {
namespace {

bool fitsByte(LogOdds log_odds) {
  return log_odds == kUnknown || (log_odds > BlockLogOdds::kUnknownByte && log_odds <= INT8_MAX);
}

}  // namespace

BlockLogOdds::BlockLogOdds(const BlockLogOdds& other)
    : bytes_(other.bytes_), wide_(other.wide_ ? std::make_unique<Wide>(*other.wide_) : nullptr) {}

BlockLogOdds& BlockLogOdds::operator=(const BlockLogOdds& other) {
  return *this = BlockLogOdds(other);
}

void BlockLogOdds::widen() {
  auto wide = std::make_unique<Wide>();
  for (int i = 0; i < kBlockCells; ++i) (*wide)[static_cast<std::size_t>(i)] = (*this)[i];
  wide_ = std::move(wide);
}

void BlockLogOdds::set(int index, LogOdds log_odds) {
  const auto i = static_cast<std::size_t>(index);
  if (!wide_ && !fitsByte(log_odds)) widen();
  if (wide_) {
    (*wide_)[i] = log_odds;
  } else {
    bytes_[i] = log_odds == kUnknown ? kUnknownByte : static_cast<std::int8_t>(log_odds);
  }
}

void BlockLogOdds::fill(LogOdds log_odds) {
  for (int i = 0; i < kBlockCells; ++i) set(i, log_odds);
}

void BlockLogOdds::add(const BlockLogOdds& other) {
  for (int i = 0; i < kBlockCells; ++i) {
    if (other[i] != kUnknown) set(i, addedLogOdds((*this)[i], other[i]));
  }
}

std::size_t BlockLogOdds::knownCells() const {
  std::size_t known = 0;
  for (int i = 0; i < kBlockCells; ++i) known += (*this)[i] != kUnknown;
  return known;
}

bool operator==(const BlockLogOdds& a, const BlockLogOdds& b) {
  if (a.isNarrow() && b.isNarrow()) return a.bytes_ == b.bytes_;
  for (int i = 0; i < kBlockCells; ++i) {
    if (a[i] != b[i]) return false;
  }
  return true;
}

SurfaceCell& Block::addSurface(int index) {
  // Room grows by an eighth: a vector of its own mind would keep up to half of itself in reserve.
  const std::size_t count = surfaces_.size();
  if (count == surfaces_.capacity()) surfaces_.reserve(count + std::max<std::size_t>(2, count / 8));
  const auto place = surfaces_.begin() + static_cast<std::ptrdiff_t>(rank(index));
  mask_[static_cast<std::size_t>(index >> 6)] |= std::uint64_t{1} << (index & 63);
  return *surfaces_.insert(place, SurfaceCell{});
}

void Block::setSurfaces(const CellBits& mask, std::vector<SurfaceCell> surfaces) {
  mask_ = mask;
  surfaces_ = std::move(surfaces);
  assert(rank(kBlockCells - 1) + hasSurface(kBlockCells - 1) == surfaces_.size());
}

void Block::merge(const Block& other) {
  log_odds.add(other.log_odds);
  other.forEachSurface([this](int index, const SurfaceCell& cell) { surfaceOrNew(index).merge(cell); });
}

std::size_t Block::memoryBytes() const {
  return sizeof(Block) + log_odds.heapBytes() + surfaces_.capacity() * sizeof(SurfaceCell);
}

}  // namespace thermovox
