#pragma once

#include <optional>
#include <string_view>

/// Declares a function compiled for the vectors of a level. What is to be fast is one loop in a function
/// marked THERMOVOX_INLINE_LOOP, called from one function a level, and cpuLevel() chooses among these:
///   THERMOVOX_INLINE_LOOP void scaleLoop(Data& d) { for (...) ... }
///   void scaleBaseline(Data& d) { scaleLoop(d); }
///   THERMOVOX_TARGET_AVX2 void scaleAvx2(Data& d) { scaleLoop(d); }
///   THERMOVOX_TARGET_AVX512 void scaleAvx512(Data& d) { scaleLoop(d); }
/// On processors other than x86-64 all levels are the baseline. A file that computes with floating point in
/// such loops is compiled with -ffp-contract=off, so that every level gives the same bits.
#if defined(__x86_64__) && defined(__GNUC__)
#define THERMOVOX_AVX2_FEATURES "avx2,bmi,bmi2,fma,popcnt"
#define THERMOVOX_AVX512_FEATURES THERMOVOX_AVX2_FEATURES ",avx512f,avx512bw,avx512cd,avx512dq,avx512vl"
#define THERMOVOX_TARGET_AVX2 __attribute__((target(THERMOVOX_AVX2_FEATURES)))
#if defined(__clang__)
#define THERMOVOX_TARGET_AVX512 __attribute__((target(THERMOVOX_AVX512_FEATURES)))
#else
#define THERMOVOX_TARGET_AVX512 __attribute__((target(THERMOVOX_AVX512_FEATURES ",prefer-vector-width=512")))
#endif
#else
#define THERMOVOX_TARGET_AVX2
#define THERMOVOX_TARGET_AVX512
#endif
#define THERMOVOX_INLINE_LOOP __attribute__((always_inline)) inline

namespace thermovox {

/// Which vector instructions the loops may use: those of every x86-64-v2 or ARM64 processor, AVX2 (with FMA
/// and BMI), or AVX-512 (F, BW, CD, DQ, VL). The results are the same bits at every level.
enum class CpuLevel { baseline, avx2, avx512 };

/// The best level of this processor, asked once. The environment variable THERMOVOX_CPU_LEVEL (baseline,
/// avx2, avx512) lowers it, for tests and measurements; a level that the processor lacks, or another word, is
/// not followed.
[[nodiscard]] CpuLevel cpuLevel();

/// The level with that name; nullopt for any other word.
[[nodiscard]] std::optional<CpuLevel> cpuLevelNamed(std::string_view name);
[[nodiscard]] std::string_view nameOf(CpuLevel level);

}  // namespace thermovox
