#include "apps/simulate/capture_options.hpp"

#include <string>

#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

void requireBetween(const std::string& option, double value, double smallest, double largest) {
  if (value >= smallest && value <= largest) return;  // written so that NaN is refused too
  throw ConfigError("simulate: " + option + " is " + std::to_string(value) + ", expected " +
                    std::to_string(smallest) + " to " + std::to_string(largest));
}

void requireCount(const std::string& option, int value, int smallest, int largest) {
  if (value >= smallest && value <= largest) return;
  throw ConfigError("simulate: " + option + " is " + std::to_string(value) + ", expected " +
                    std::to_string(smallest) + " to " + std::to_string(largest));
}

}  // namespace

void CaptureOptions::validate() const {
  requireCount("captures", captures, 1, 1000);
  requireCount("edge_captures", edge_captures, 0, 1000);
  requireCount("spoiled (of the captures)", spoiled, 0, captures);
  if (edge_captures > 0 && laser != LaserKind::beam) {
    throw ConfigError("simulate: edge_captures is " + std::to_string(edge_captures) +
                      ", expected 0 unless the laser is a beam: scans and clouds see the edges anyway");
  }
  requireBetween("range_sigma [m]", range_sigma, 0.0, 1.0);
  requireBetween("capture_bias_sigma [m]", capture_bias_sigma, 0.0, 1.0);
  requireBetween("netd [C]", netd, 0.0, 10.0);
  requireBetween("blur_px", blur_px, 0.0, 5.0);
  requireBetween("contrast [C]", contrast, 0.0, 15.0);
  requireBetween("beam_spot_sigma [m]", beam_spot_sigma, 0.0, 0.01);
  requireBetween("guess.rotation_sigma [rad]", guess.rotation_sigma, 0.0, 0.5);
  requireBetween("guess.translation_sigma [m]", guess.translation_sigma, 0.0, 1.0);
  requireCount("threads", static_cast<int>(threads), 1, 256);
}

}  // namespace thermovox::simulate
