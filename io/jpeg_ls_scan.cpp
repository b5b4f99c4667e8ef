#include "io/jpeg_ls_scan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <vector>

#include "projection/error.hpp"

namespace thermovox {
namespace {

[[noreturn]] void refuse(const std::string& what, const char* why) {
  throw DataError(what + " is a damaged JPEG-LS picture: " + why);
}

/// The bits of a scan, the first of a byte first. After a byte of ones comes a bit of 0 that means nothing; a
/// bit of 1 there is a marker, where the scan ends.
class Bits {
 public:
  Bits(std::span<const std::byte> bytes, const std::string& what) : bytes_(bytes), what_(what) {}

  /// Up to 32 bits as a number.
  std::uint32_t take(int count) {
    if (count == 0) return 0;
    need(count);
    const auto value = static_cast<std::uint32_t>(cache_ >> (64 - count));
    drop(count);
    return value;
  }
  bool takeOne() { return take(1) != 0; }

  /// Counts the zeros before the next one, and takes both. Throws where they are more than `most`.
  int takeZeros(int most) {
    int zeros = 0;
    while (cache_ == 0) {  // nothing but zeros are known
      zeros += known_;
      drop(known_);
      need(1);
      if (zeros > most) refuse(what_, "a code word is too long");
    }
    const int more = std::countl_zero(cache_);
    drop(more + 1);
    if (zeros + more > most) refuse(what_, "a code word is too long");
    return zeros + more;
  }

 private:
  void drop(int count) {
    cache_ = count < 64 ? cache_ << count : 0;
    known_ -= count;
  }

  void need(int count) {
    if (known_ >= count) return;
    while (known_ <= 56 && place_ < bytes_.size()) {
      const auto byte = std::to_integer<std::uint64_t>(bytes_[place_]);
      if (after_ones_ && byte >= 0x80) break;
      const int length = after_ones_ ? 7 : 8;
      cache_ |= byte << (64 - length - known_);
      known_ += length;
      after_ones_ = byte == 0xFF;
      ++place_;
    }
    if (known_ < count) refuse(what_, "it ends before its last pixel");
  }

  std::span<const std::byte> bytes_;
  const std::string& what_;
  std::size_t place_ = 0;
  bool after_ones_ = false;
  std::uint64_t cache_ = 0;  ///< the known bits, from the most significant one on, then zeros
  int known_ = 0;
};

/// What was learnt in one surrounding (T.87, A.2): sums of the errors' sizes and of the errors, a correction
/// of the prediction, and how many errors that was.
struct Context {
  int a = 0;
  int b = 0;
  int c = 0;
  int n = 1;
};

/// The same of samples that end a run; the errors below 0 are counted.
struct RunContext {
  int a = 0;
  int n = 1;
  int negative = 0;
};

/// Bits of the lengths of runs, by how well runs went (T.87, A.2.1).
constexpr std::array<int, 32> kRunBits{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,  2,  3,  3,  3,  3,
                                       4, 4, 5, 5, 6, 6, 7, 7, 8, 9, 10, 11, 12, 13, 14, 15};

class Scan {
 public:
  Scan(std::span<const std::byte> bytes, const JpegLsCoding& coding, const std::string& what)
      : bits_(bytes, what), what_(what), coding_(coding), step_(2 * coding.near + 1) {
    range_ = (coding.max_value + 2 * coding.near) / step_ + 1;
    error_bits_ = std::bit_width(static_cast<unsigned>(range_ - 1));
    const int sample_bits = std::bit_width(static_cast<unsigned>(coding.max_value));
    limit_ = 2 * (sample_bits + std::max(8, sample_bits));
    const int start = std::max(2, (range_ + 32) / 64);
    contexts_.fill({.a = start});
    run_contexts_.fill({.a = start});
  }

  /// A row; both begin with the sample on the left of the first one, and `above` has one more at its end.
  void decodeRow(const int* above, int* row, std::size_t width) {
    for (std::size_t x = 1; x <= width;) {
      const int gradients = 81 * quantized(above[x + 1] - above[x]) + 9 * quantized(above[x] - above[x - 1]) +
                            quantized(above[x - 1] - row[x - 1]);
      if (gradients != 0) {
        row[x] = regularSample(gradients, row[x - 1], above[x], above[x - 1]);
        ++x;
        continue;
      }
      x += run(row + x, width - x + 1);
      if (x > width) break;
      row[x] = runEnd(row[x - 1], above[x]);
      ++x;
    }
  }

 private:
  [[nodiscard]] int quantized(int gradient) const {
    const int size = std::abs(gradient);
    const int level = size <= coding_.near ? 0
                      : size < coding_.t1  ? 1
                      : size < coding_.t2  ? 2
                      : size < coding_.t3  ? 3
                                           : 4;
    return gradient < 0 ? -level : level;
  }

  /// A Golomb code with k bits below (T.87, A.5.3).
  int golomb(int k, int limit) {
    const int longest = limit - error_bits_ - 1;
    const int zeros = bits_.takeZeros(longest);
    if (zeros == longest) return static_cast<int>(bits_.take(error_bits_)) + 1;
    return (zeros << k) + static_cast<int>(bits_.take(k));
  }

  int golombBits(int n, int a) const {
    constexpr int most_bits = 16, most_error = 1 << 24;  // of samples of 16 bits
    int k = 0;
    while (k <= most_bits && std::int64_t{n} << k < a) ++k;
    if (k > most_bits || a > most_error) refuse(what_, "its errors have no end");
    return k;
  }

  /// A prediction and its error make a sample, modulo the range.
  int sampleOf(int predicted, int error) {
    if (error < -range_ || error > range_) refuse(what_, "an error is larger than any sample");
    int sample = predicted + error * step_;
    if (sample < -coding_.near) sample += range_ * step_;
    if (sample > coding_.max_value + coding_.near) sample -= range_ * step_;
    return std::clamp(sample, 0, coding_.max_value);
  }

  int regularSample(int gradients, int left, int up, int corner) {
    const int sign = gradients < 0 ? -1 : 1;
    Context& context = contexts_[static_cast<std::size_t>(sign * gradients)];
    const int predicted =
        std::clamp(edgePrediction(left, up, corner) + sign * context.c, 0, coding_.max_value);
    const int k = golombBits(context.n, context.a);
    const int mapped = golomb(k, limit_);
    int error = mapped % 2 == 0 ? mapped / 2 : -(mapped / 2) - 1;
    if (coding_.near == 0 && k == 0 && 2 * context.b <= -context.n) error = -error - 1;
    const int sample = sampleOf(predicted, sign * error);
    learn(context, error);
    return sample;
  }

  static int edgePrediction(int left, int up, int corner) {
    const auto [low, high] = std::minmax(left, up);
    if (corner >= high) return low;
    if (corner <= low) return high;
    return left + up - corner;
  }

  void learn(Context& context, int error) const {
    context.a += std::abs(error);
    context.b += error * step_;
    if (context.n == coding_.reset) {
      context.a >>= 1;
      context.b >>= 1;
      context.n >>= 1;
    }
    ++context.n;
    if (context.b <= -context.n) {
      context.b = std::max(context.b + context.n, 1 - context.n);
      context.c = std::max(context.c - 1, -128);
    } else if (context.b > 0) {
      context.b = std::min(context.b - context.n, 0);
      context.c = std::min(context.c + 1, 127);
    }
  }

  /// Repeats the sample on the left; returns how often. As often as there is `room`, the row is full.
  std::size_t run(int* samples, std::size_t room) {
    std::size_t length = 0;
    while (length < room && bits_.takeOne()) {
      const std::size_t step = std::size_t{1} << kRunBits[static_cast<std::size_t>(run_index_)];
      if (step <= room - length && run_index_ < 31) ++run_index_;
      length += std::min(step, room - length);
      if (length == room) {
        std::fill_n(samples, length, samples[-1]);
        return length;
      }
    }
    length += bits_.take(kRunBits[static_cast<std::size_t>(run_index_)]);
    if (length >= room) refuse(what_, "a run is longer than its row");
    std::fill_n(samples, length, samples[-1]);
    return length;
  }

  /// The sample that ends a run (T.87, A.7.2).
  int runEnd(int left, int up) {
    const int equal = std::abs(left - up) <= coding_.near ? 1 : 0;
    RunContext& context = run_contexts_[static_cast<std::size_t>(equal)];
    const int k = golombBits(context.n, context.a + equal * (context.n >> 1));
    const int mapped = golomb(k, limit_ - kRunBits[static_cast<std::size_t>(run_index_)] - 1);
    const int odd = (mapped + equal) % 2;
    int error = (mapped + equal + odd) / 2;
    const bool negative_is_odd = k != 0 || 2 * context.negative >= context.n;
    if (negative_is_odd == (odd == 1)) error = -error;
    const int sample = equal == 1 ? sampleOf(left, error) : sampleOf(up, left > up ? -error : error);
    if (error < 0) ++context.negative;
    context.a += (mapped + 1 - equal) >> 1;
    if (context.n == coding_.reset) {
      context.a >>= 1;
      context.n >>= 1;
      context.negative >>= 1;
    }
    ++context.n;
    if (run_index_ > 0) --run_index_;
    return sample;
  }

  Bits bits_;
  const std::string& what_;
  JpegLsCoding coding_;
  int step_ = 1;        ///< from one possible value of an error to the next
  int range_ = 0;       ///< how many such values there are
  int error_bits_ = 0;  ///< of an error written as it is
  int limit_ = 0;
  int run_index_ = 0;
  std::array<Context, 365> contexts_{};
  std::array<RunContext, 2> run_contexts_{};
};

}  // namespace

JpegLsCoding usualJpegLsCoding(int max_value, int near) {
  // T.87, C.2.4.1.1.1: three thresholds that grow with the number of bits.
  const int factor = (std::min(max_value, 4095) + 128) / 256;
  const auto within = [max_value](int threshold, int lowest) {
    return threshold > max_value || threshold < lowest ? lowest : threshold;
  };
  JpegLsCoding coding{.max_value = max_value, .near = near};
  coding.t1 = within(factor + 2 + 3 * near, near + 1);
  coding.t2 = within(4 * factor + 3 + 5 * near, coding.t1);
  coding.t3 = within(17 * factor + 4 + 7 * near, coding.t2);
  return coding;
}

void decodeJpegLsScan(std::span<const std::byte> bytes, const JpegLsCoding& coding, std::size_t width,
                      std::span<std::uint16_t> samples, const std::string& what) {
  Scan scan(bytes, coding, what);
  // On the left of a row stands the sample above its first one, on the right of a row its last one again.
  std::vector<int> above(width + 2);
  std::vector<int> row(width + 2);
  for (std::size_t first = 0; first < samples.size(); first += width) {
    row[0] = above[1];
    scan.decodeRow(above.data(), row.data(), width);
    row[width + 1] = row[width];
    std::transform(row.begin() + 1, row.end() - 1, samples.begin() + static_cast<std::ptrdiff_t>(first),
                   [](int sample) { return static_cast<std::uint16_t>(sample); });
    std::swap(above, row);
  }
}

}  // namespace thermovox
