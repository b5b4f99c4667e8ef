#include "apps/simulate/simulation_options.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>

#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

[[noreturn]] void refuse(const std::string& option, double value, const std::string& expected) {
  throw ConfigError("simulate: " + option + " is " + std::to_string(value) + ", expected " + expected);
}

void requirePositive(const std::string& option, double value, double largest) {
  if (!(value > 0.0 && value <= largest)) {
    refuse(option, value, "more than 0 and at most " + std::to_string(largest));
  }
}

void requireNotNegative(const std::string& option, double value, double largest) {
  if (!(value >= 0.0 && value <= largest)) {
    refuse(option, value, "between 0 and " + std::to_string(largest));
  }
}

void requireCelsius(const std::string& option, double value) {
  if (!(value >= -60.0 && value <= 80.0)) refuse(option, value, "-60 to 80");
}

void requireShare(const std::string& option, double value) {
  if (!(value >= 0.05 && value <= 1.0)) refuse(option, value, "0.05 to 1");
}

}  // namespace

void SimulationOptions::validate() const {
  requirePositive("duration [s]", duration, 3600.0);
  requirePositive("frame_rate [1/s]", frame_rate, 1000.0);
  requirePositive("pose_rate [1/s]", pose_rate, 1000.0);
  requirePositive("beam_rate [1/s]", beam_rate, 10000.0);
  requirePositive("scan_rate [1/s]", scan_rate, 200.0);
  requirePositive("cloud_rate [1/s]", cloud_rate, 200.0);
  requireNotNegative("netd [C]", netd, 10.0);
  requireNotNegative("humidity", humidity, 1.0);
  requireCelsius("air [C]", air);
  requireShare("emissivity", emissivity);
  requireCelsius("reflected [C]", reflected.value_or(air));
  requireShare("window_transmission", window_transmission);
  requireCelsius("window_temperature [C]", window_temperature.value_or(air));
  requireNotNegative("blur_px", blur_px, 5.0);
  requireNotNegative("range_sigma [m]", range_sigma, 1.0);
  requireNotNegative("outlier_share", outlier_share, 1.0);
  requireNotNegative("errors.pose_rotation_sigma [rad]", errors.pose_rotation_sigma, 0.5);
  requireNotNegative("errors.pose_translation_sigma [m]", errors.pose_translation_sigma, 10.0);
  requireNotNegative("errors.camera_bias_sigma [C]", errors.camera_bias_sigma, 100.0);
  requireNotNegative("errors.range_bias_sigma [m]", errors.range_bias_sigma, 1.0);
  if (supersampling < 1 || supersampling > 9) refuse("supersampling", supersampling, "1 to 9");
  if (threads < 1 || threads > 256) refuse("threads", threads, "1 to 256");
  const Matrix6d& covariance = errors.covariance_body_laser;
  const double scale = covariance.cwiseAbs().maxCoeff();
  if (!covariance.allFinite() || (covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale ||
      Eigen::SelfAdjointEigenSolver<Matrix6d>(covariance).eigenvalues().minCoeff() < -1e-9 * scale) {
    throw ConfigError(
        "simulate: errors.covariance_body_laser is not a covariance, expected a symmetric positive matrix");
  }
}

}  // namespace thermovox::simulate
