#include "mapping/block_update.hpp"

#include <algorithm>
#include <bit>
#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace thermovox {
namespace {

std::int8_t updated(std::int8_t log_odds, bool hit, const OccupancySteps& steps) {
  const int before = log_odds == BlockLogOdds::kUnknownByte ? 0 : log_odds;
  if (!hit) return static_cast<std::int8_t>(std::max<int>(before + steps.miss, steps.lowest));
  return static_cast<std::int8_t>(
      std::min<int>(std::max<int>(before, steps.before_hit) + steps.hit, steps.highest));
}

/// One word of 64 cells.
void updateWord(std::int8_t* cells, std::uint64_t passed, std::uint64_t hit, const OccupancySteps& steps) {
  for (std::uint64_t bits = passed | hit; bits != 0; bits &= bits - 1) {
    const int i = std::countr_zero(bits);
    cells[i] = updated(cells[i], (hit >> i & 1) != 0, steps);
  }
}

#ifdef __x86_64__
THERMOVOX_TARGET_AVX512 void updateWordAvx512(std::int8_t* cells, std::uint64_t passed, std::uint64_t hit,
                                              const OccupancySteps& steps) {
  __m512i before = _mm512_loadu_si512(cells);
  const __mmask64 unknown = _mm512_cmpeq_epi8_mask(before, _mm512_set1_epi8(BlockLogOdds::kUnknownByte));
  const __m512i known = _mm512_mask_mov_epi8(before, unknown, _mm512_setzero_si512());
  const __m512i freed =
      _mm512_max_epi8(_mm512_adds_epi8(known, _mm512_set1_epi8(steps.miss)), _mm512_set1_epi8(steps.lowest));
  const __m512i raised = _mm512_max_epi8(known, _mm512_set1_epi8(steps.before_hit));
  const __m512i filled =
      _mm512_min_epi8(_mm512_adds_epi8(raised, _mm512_set1_epi8(steps.hit)), _mm512_set1_epi8(steps.highest));
  before = _mm512_mask_mov_epi8(before, passed, freed);
  _mm512_storeu_si512(cells, _mm512_mask_mov_epi8(before, hit, filled));
}

/// All bits of the bytes whose bits are set.
THERMOVOX_TARGET_AVX2 __m256i bytesOf(std::uint32_t bits) {
  const __m256i spread = _mm256_setr_epi8(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1,  //
                                          2, 2, 2, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3);
  const __m256i one_each = _mm256_set1_epi64x(static_cast<long long>(0x8040201008040201ULL));
  const __m256i copies = _mm256_shuffle_epi8(_mm256_set1_epi32(static_cast<int>(bits)), spread);
  return _mm256_cmpeq_epi8(_mm256_and_si256(copies, one_each), one_each);
}

THERMOVOX_TARGET_AVX2 void updateHalfAvx2(std::int8_t* cells, std::uint32_t passed, std::uint32_t hit,
                                          const OccupancySteps& steps) {
  const __m256i before = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(cells));
  const __m256i unknown = _mm256_cmpeq_epi8(before, _mm256_set1_epi8(BlockLogOdds::kUnknownByte));
  const __m256i known = _mm256_andnot_si256(unknown, before);
  const __m256i freed =
      _mm256_max_epi8(_mm256_adds_epi8(known, _mm256_set1_epi8(steps.miss)), _mm256_set1_epi8(steps.lowest));
  const __m256i raised = _mm256_max_epi8(known, _mm256_set1_epi8(steps.before_hit));
  const __m256i filled =
      _mm256_min_epi8(_mm256_adds_epi8(raised, _mm256_set1_epi8(steps.hit)), _mm256_set1_epi8(steps.highest));
  const __m256i after = _mm256_blendv_epi8(before, freed, bytesOf(passed));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(cells), _mm256_blendv_epi8(after, filled, bytesOf(hit)));
}

THERMOVOX_TARGET_AVX2 void updateWordAvx2(std::int8_t* cells, std::uint64_t passed, std::uint64_t hit,
                                          const OccupancySteps& steps) {
  updateHalfAvx2(cells, static_cast<std::uint32_t>(passed), static_cast<std::uint32_t>(hit), steps);
  updateHalfAvx2(cells + 32, static_cast<std::uint32_t>(passed >> 32), static_cast<std::uint32_t>(hit >> 32),
                 steps);
}
#endif

auto wordUpdate(CpuLevel level) {
#ifdef __x86_64__
  if (level == CpuLevel::avx512) return updateWordAvx512;
  if (level == CpuLevel::avx2) return updateWordAvx2;
#endif
  (void)level;
  return updateWord;
}

}  // namespace

void updateLogOdds(BlockLogOdds::Bytes& log_odds, const CellBits& passed, const CellBits& hit,
                   const OccupancySteps& steps, CpuLevel level) {
  const auto update = wordUpdate(level);
  for (std::size_t word = 0; word < hit.size(); ++word) {
    if ((passed[word] | hit[word]) == 0) continue;
    update(log_odds.data() + 64 * word, passed[word], hit[word], steps);
  }
}

}  // namespace thermovox
