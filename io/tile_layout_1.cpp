#include "io/tile_layout_1.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/little_endian.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

// The layout: its number (u8), how many blocks (u16), and for each its place in the tile (u16, x fastest,
// ascending), 512 log-odds (i16), how many surfaces (u16), their cells (u16 each, ascending), and the
// surfaces. Temperatures counted from -274 C in 2^-16 C, weights in 2^-18 / C^2, squares were shifted by 24.

/// Wide enough for the sums. (ISO C++ has no 128-bit integer; GCC and Clang do, on 64-bit targets.)
__extension__ typedef unsigned __int128 Uint128;

/// A surface cell as it was.
struct OldCell {
  std::uint64_t weight_sum = 0;
  std::int64_t first_ns = 0, last_ns = 0;
  Uint128 weighted_sum = 0, weighted_square_sum = 0;
  std::array<std::uint32_t, 3> offset_sum{};
  std::uint32_t returns = 0, observations = 0;
  float min_celsius = 0.0F, max_celsius = 0.0F;
  std::uint16_t best_range_cm = 0, best_incidence = 0;
};

constexpr double kZeroCelsius = -274.0;
constexpr std::uint64_t kMostWeight = 2'560'000;  // of an observation, today: 2^10 / (0.02 C)^2
constexpr int kWeightShift = 8;                   // weights count in 2^-10 / C^2 today,
constexpr int kTemperatureShift = 7;              // temperatures in 2^-9 C,
constexpr int kSquareShift = 11;                  // and squares are shifted by 21
constexpr std::int64_t kFirstStamp = -(std::int64_t{1} << 62);
constexpr std::uint16_t kUnknownIncidence = 0xFFFF;
constexpr Uint128 kMostTemperature = Uint128{1} << 28;  // 3274 C
constexpr Uint128 kMostSquare = Uint128{1} << 32;       // its square, shifted

[[noreturn]] void refuse(const char* fault) {
  throw DataError(fault);
}
constexpr const char* kContradiction = "a surface cell contradicts itself";

/// sum * to / from / 2^shift, to the nearest: the same mean under another sum of weights. Precondition:
/// sum / from < 2^32, to < 2^44.
std::uint64_t rescaled(Uint128 sum, std::uint64_t from, std::uint64_t to, int shift) {
  const Uint128 whole = (sum / from) * to + (sum % from) * to / from;
  return static_cast<std::uint64_t>((whole + (Uint128{1} << (shift - 1))) >> shift);
}

std::uint64_t stampFromZero(std::int64_t ns) {
  return static_cast<std::uint64_t>(std::clamp(ns, kFirstStamp, -kFirstStamp - 1) - kFirstStamp);
}

std::uint64_t extremeCode(float celsius) {
  return static_cast<std::uint64_t>((static_cast<double>(celsius) - kZeroCelsius) * 16.0 + 0.5);
}

bool isTemperature(float celsius) {
  return celsius >= static_cast<float>(SurfaceCell::kMinCelsius) &&
         celsius <= static_cast<float>(SurfaceCell::kMaxCelsius);
}

void convertPosition(const OldCell& old, SurfaceCell& cell) {
  const std::uint32_t returns = std::min(old.returns, SurfaceCell::kMaxReturns);
  cell.returns = returns;
  for (std::size_t i = 0; i < 3; ++i) {
    if (old.offset_sum[i] > 255ULL * old.returns) refuse(kContradiction);
    if (old.returns > 0) cell.offset_sum[i] = std::uint64_t{old.offset_sum[i]} * returns / old.returns;
  }
}

void convertTemperature(const OldCell& old, SurfaceCell& cell) {
  if (!isTemperature(old.min_celsius) || !isTemperature(old.max_celsius) || old.weight_sum == 0 ||
      old.weighted_sum / old.weight_sum >= kMostTemperature ||
      old.weighted_square_sum / old.weight_sum >= kMostSquare) {
    refuse(kContradiction);
  }
  const std::uint64_t observations = std::min(old.observations, SurfaceCell::kMaxObservations);
  const std::uint64_t rounded = (old.weight_sum >> kWeightShift) + (old.weight_sum >> (kWeightShift - 1) & 1);
  const std::uint64_t weight = std::clamp(rounded, observations, observations * kMostWeight);
  cell.observations = observations;
  cell.weight_sum = weight;
  cell.weighted_sum = rescaled(old.weighted_sum, old.weight_sum, weight, kTemperatureShift);
  cell.weighted_square_sum = rescaled(old.weighted_square_sum, old.weight_sum, weight, kSquareShift);
  cell.first_code = stampFromZero(old.first_ns) >> 31;
  cell.last_code = stampFromZero(old.last_ns) >> 15;
  cell.min_code = extremeCode(old.min_celsius);
  cell.max_code = extremeCode(old.max_celsius);
  cell.best_range_cm = old.best_range_cm;
  cell.best_incidence = old.best_incidence == kUnknownIncidence
                            ? std::uint64_t{SurfaceCell::kUnknownIncidence}
                            : std::min<std::uint64_t>((old.best_incidence + 50U) / 100U, 254);
}

class Reader {
 public:
  Reader(const TileKey& key, std::string_view content) : key_(key), reader_(content) {}

  TileBlocks blocks() {
    (void)next<std::uint8_t>();  // the layout's number
    const int count = next<std::uint16_t>();
    if (count > kTileBlocks) refuse("it has too many blocks");
    TileBlocks blocks;
    int place = -1;
    for (int i = 0; i < count; ++i) {
      place = ascending(place, kTileBlocks, "its blocks are out of order");
      blocks.emplace(blockAt(key_, place), block());
    }
    if (reader_.left() != 0) refuse("it is longer than its blocks");
    return blocks;
  }

 private:
  template <typename T>
  T next() {
    const std::optional<T> number = reader_.next<T>();
    if (!number) refuse("it ends too early");
    return *number;
  }
  int ascending(int last, int limit, const char* fault) {
    const int place = next<std::uint16_t>();
    if (place <= last || place >= limit) refuse(fault);
    return place;
  }
  Uint128 nextSum() {
    const std::uint64_t low = next<std::uint64_t>();
    return Uint128{next<std::uint32_t>()} << 64 | low;
  }

  Block block() {
    Block block;
    for (int i = 0; i < kBlockCells; ++i) block.log_odds.set(i, next<LogOdds>());
    const int count = next<std::uint16_t>();
    if (count > kBlockCells) refuse("it has too many surfaces");
    CellBits mask{};
    int index = -1;
    for (int i = 0; i < count; ++i) {
      index = ascending(index, kBlockCells, "its surfaces are out of order");
      mask[static_cast<std::size_t>(index / 64)] |= std::uint64_t{1} << (index % 64);
    }
    std::vector<SurfaceCell> surfaces;
    for (int i = 0; i < count; ++i) surfaces.push_back(surface());
    block.setSurfaces(mask, std::move(surfaces));
    return block;
  }

  SurfaceCell surface() {
    OldCell old;
    old.weight_sum = next<std::uint64_t>();
    old.first_ns = next<std::int64_t>();
    old.last_ns = next<std::int64_t>();
    old.weighted_sum = nextSum();
    old.weighted_square_sum = nextSum();
    for (std::uint32_t& sum : old.offset_sum) sum = next<std::uint32_t>();
    old.returns = next<std::uint32_t>();
    old.observations = next<std::uint32_t>();
    old.min_celsius = next<float>();
    old.max_celsius = next<float>();
    old.best_range_cm = next<std::uint16_t>();
    old.best_incidence = next<std::uint16_t>();
    SurfaceCell cell;
    convertPosition(old, cell);
    if (old.observations > 0) convertTemperature(old, cell);
    if (!cell.isPlausible()) refuse(kContradiction);
    return cell;
  }

  TileKey key_;
  LittleEndianReader reader_;
};

}  // namespace

TileBlocks readTileOfLayout1(const TileKey& key, std::string_view content) {
  return Reader(key, content).blocks();
}

}  // namespace thermovox
