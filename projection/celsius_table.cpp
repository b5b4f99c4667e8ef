#include "projection/celsius_table.hpp"

#include <algorithm>
#include <cassert>

namespace thermovox {
namespace {

constexpr std::size_t kCounts = 65536;

}  // namespace

CelsiusTable::CelsiusTable(const RadiometricParameters& parameters) : parameters_(parameters) {
  parameters_.validate();
}

void CelsiusTable::convert(std::span<const std::uint16_t> counts, std::span<float> celsius) {
  assert(counts.size() == celsius.size());
  if (counts.empty()) return;
  std::uint16_t least = counts[0], most = counts[0];
  for (const std::uint16_t count : counts) {
    least = std::min(least, count);
    most = std::max(most, count);
  }
  grow(least, most);
  const float* const table = celsius_.data();
  for (std::size_t i = 0; i < counts.size(); ++i) celsius[i] = table[counts[i]];
}

void CelsiusTable::grow(std::size_t first, std::size_t last) {
  if (begin_ == end_) {
    celsius_.resize(kCounts);
    begin_ = end_ = first;
  }
  if (first < begin_) {
    fill(first, begin_);
    begin_ = first;
  }
  if (last + 1 > end_) {
    fill(end_, last + 1);
    end_ = last + 1;
  }
}

void CelsiusTable::fill(std::size_t begin, std::size_t end) {
  const PlanckConstants planck = parameters_.planck;
  const SignalLine line = objectSignal(parameters_);
  float* const table = celsius_.data();
  for (std::size_t i = begin; i < end; ++i)
    table[i] = static_cast<float>(planck.celsius(line(static_cast<double>(i))));
}

}  // namespace thermovox
