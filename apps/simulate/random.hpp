#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace thermovox::simulate {

/// What a stream of random numbers is for: streams of one seed are independent of each other, so that, say,
/// the noise of frame 7 does not depend on how many rays the laser cast.
enum class RandomStream : std::uint64_t {
  hall,
  flight,
  errors,
  thermal_noise,
  laser = 5,
  capture_rig,
  capture_boards,
  capture_motion,
  visible_noise
};

/// Random numbers whose values do not depend on the standard library: the generator is fixed by the standard
/// and the distributions are made from its bits here.
class Random {
 public:
  /// `index` is the item (frame, sweep) that the numbers are for.
  Random(std::uint64_t seed, RandomStream stream, std::uint64_t index = 0);

  [[nodiscard]] double uniform() { return static_cast<double>(bits_() >> 11) * 0x1.0p-53; }  ///< [0, 1)
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// 0 .. count - 1.
  [[nodiscard]] int index(int count) { return static_cast<int>(uniform() * count); }
  /// Mean 0, standard deviation 1 (Box and Muller 1958).
  [[nodiscard]] double normal();
  [[nodiscard]] Eigen::Vector3d normal3();

 private:
  std::mt19937_64 bits_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace thermovox::simulate
