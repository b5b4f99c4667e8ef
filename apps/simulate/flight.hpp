#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "apps/simulate/hall.hpp"
#include "apps/simulate/simulation_options.hpp"
#include "projection/trajectory.hpp"

namespace thermovox::simulate {

/// A smooth path down the aisle and back, lap after lap, with a swinging attitude. Analytic: any time has its
/// exact pose.
class Flight {
 public:
  /// Stamp of time 0: every simulated mission begins here.
  static constexpr Time kStart{std::chrono::seconds(1'760'000'000)};

  /// A lap takes `duration` seconds, but no less than 6 and no more than 40.
  Flight(const Hall& hall, FlightStyle style, double duration, std::uint64_t seed);

  /// T_world_body, `seconds` after kStart.
  [[nodiscard]] Pose at(double seconds) const;
  [[nodiscard]] Pose at(Time stamp) const { return at(toSeconds(stamp - kStart)); }

  /// Poses at `rate` a second from `from` to `to` seconds, both included.
  [[nodiscard]] std::vector<StampedPose> sample(double from, double to, double rate) const;

 private:
  [[nodiscard]] double headingOf(double half_laps) const;

  FlightStyle style_;
  double half_length_ = 0.0;  ///< the path spans +-this in x, metres
  double lap_ = 6.0;          ///< seconds
  std::array<double, 6> phases_{};
};

}  // namespace thermovox::simulate
